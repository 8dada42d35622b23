#include "lightfield/capture_writer.h"

#include "config/error.h"
#include "hal/image_io.h"
#include "lightfield/points_file.h"
#include "lightfield/transforms.h"

namespace lumibox::lightfield {
namespace {

/// JSON has no NaN: one bad pose written would make the whole capture unreadable.
void require_finite(int id, const geometry::Pose& pose) {
  if (pose.rotation.coeffs().allFinite() && pose.translation.allFinite()) return;
  throw config::InputError("the pose of perspective " + std::to_string(id) + " is not finite");
}

}  // namespace

CaptureWriter::CaptureWriter(std::filesystem::path folder, int jpeg_quality, DurableFiles files)
    : folder_(std::move(folder)),
      jpeg_quality_(jpeg_quality),
      files_(std::move(files)),
      lock_(make_capture_folder(files_, folder_)),
      map_(folder_, 0) {
  changed_ = true;
  commit();
  files_.make_folder(folder_ / kImagesFolder);
}

CaptureWriter::CaptureWriter(const Capture& capture, std::size_t keyframes, int jpeg_quality,
                             DurableFiles files)
    : folder_(capture.folder),
      jpeg_quality_(jpeg_quality),
      files_(std::move(files)),
      lock_(folder_),
      map_(folder_, keyframes),
      header_{capture.light_field.subject(), capture.threshold, !capture.points.empty()},
      changed_(true) {
  for (const Perspective& perspective : capture.light_field.perspectives()) {
    named_[perspective.id] = perspective;
    named_[perspective.id].photo.reset();
    named_on_disk_.insert(perspective.file);
  }
  pictures_ = named_on_disk_;
}

void CaptureWriter::put(const Perspective& perspective, std::string file) {
  Perspective named = perspective;
  named.photo.reset();
  named.file = std::move(file);
  named_[perspective.id] = std::move(named);
  changed_ = true;
}

void CaptureWriter::add(const Perspective& perspective) {
  require_finite(perspective.id, perspective.world_from_camera);
  require_finite(perspective.id, perspective.keyframe_from_camera);
  const std::string file = picture_file(perspective.id);
  files_.write(folder_ / file, hal::encode_jpeg(*perspective.photo->require_rgb(), jpeg_quality_));
  perspective.photo->stored_in(folder_ / file);
  pictures_.insert(file);
  put(perspective, file);
}

void CaptureWriter::remove(int id) {
  if (named_.erase(id) > 0) changed_ = true;
}

void CaptureWriter::restore(const Perspective& perspective) {
  // One that was here before this recording keeps its file: the original, maybe a PNG.
  const std::string file =
      perspective.file.empty() ? picture_file(perspective.id) : perspective.file;
  pictures_.contains(file) ? put(perspective, file) : add(perspective);
}

void CaptureWriter::set_subject(const Sphere& sphere) {
  commit();  // what came before this move is written without it
  header_.subject = sphere;
  moved_ = true;
}

void CaptureWriter::set_pose(int id, const geometry::Pose& world_from_camera) {
  const auto found = named_.find(id);
  if (found == named_.end()) return;
  require_finite(id, world_from_camera);
  commit();  // likewise
  found->second.world_from_camera = world_from_camera;
  moved_ = true;
}

void CaptureWriter::hang(int id, int keyframe, const geometry::Pose& keyframe_from_camera) {
  const auto found = named_.find(id);
  if (found == named_.end()) return;
  require_finite(id, keyframe_from_camera);
  commit();  // likewise
  found->second.keyframe = keyframe;
  found->second.keyframe_from_camera = keyframe_from_camera;
  moved_ = true;
}

void CaptureWriter::set_points(const std::vector<Eigen::Vector3d>& points) {
  files_.write(folder_ / kPointsFile, encode_ply(points));
  if (!header_.has_points) changed_ = true;
  header_.has_points = true;
}

std::optional<std::string> CaptureWriter::set_map(const tracking::MapView& map,
                                                  const geometry::Camera& camera) {
  // A capture that is gone on with may hang on keyframes that went with the power, and this map
  // may have others of their numbers: what it hangs on now goes first.
  commit();
  try {
    map_.write(map, camera, files_);
  } catch (const config::InputError& error) {
    return error.what();
  }
  return std::nullopt;
}

void CaptureWriter::set_threshold(double radians) {
  header_.threshold = radians;
  moved_ = true;
}

void CaptureWriter::commit_moves() {
  if (moved_) changed_ = true;
  commit();
}

void CaptureWriter::commit() {
  if (!changed_) return;
  std::vector<Perspective> perspectives;
  std::set<std::string> files;
  for (const auto& [id, perspective] : named_) {
    perspectives.push_back(perspective);
    files.insert(perspective.file);
  }
  files_.write(folder_ / kTransformsFile, transforms_json(perspectives, header_, OwnKeys::With));
  named_on_disk_ = std::move(files);
  changed_ = false;
  moved_ = false;
}

void CaptureWriter::remove_unnamed_pictures() {
  for (const std::string& picture : pictures_) {
    if (!named_on_disk_.contains(picture)) files_.remove(folder_ / picture);
  }
}

void CaptureWriter::unlock() {
  lock_.reset();
}

}  // namespace lumibox::lightfield
