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
    : folder_(std::move(folder)), jpeg_quality_(jpeg_quality), files_(std::move(files)) {
  make_new_folder(files_, folder_);
  changed_ = true;
  commit();
  files_.make_folder(folder_ / kImagesFolder);
}

void CaptureWriter::put(const Perspective& perspective) {
  Perspective named = perspective;
  named.color.reset();
  named.file = picture_file(perspective.id);
  named_[perspective.id] = std::move(named);
  changed_ = true;
}

void CaptureWriter::add(const Perspective& perspective) {
  require_finite(perspective.id, perspective.world_from_camera);
  require_finite(perspective.id, perspective.keyframe_from_camera);
  const std::string file = picture_file(perspective.id);
  files_.write(folder_ / file, hal::encode_jpeg(*perspective.color, jpeg_quality_));
  pictures_.insert(file);
  put(perspective);
}

void CaptureWriter::remove(int id) {
  if (named_.erase(id) > 0) changed_ = true;
}

void CaptureWriter::restore(const Perspective& perspective) {
  pictures_.contains(picture_file(perspective.id)) ? put(perspective) : add(perspective);
}

void CaptureWriter::set_subject(const Sphere& sphere) {
  commit();  // what came before this move is written without it
  subject_ = sphere;
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

void CaptureWriter::set_points(const std::vector<Eigen::Vector3d>& points) {
  files_.write(folder_ / kPointsFile, encode_ply(points));
  if (!has_points_) changed_ = true;
  has_points_ = true;
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
  files_.write(folder_ / kTransformsFile,
               transforms_json(perspectives, subject_, has_points_, OwnKeys::With));
  named_on_disk_ = std::move(files);
  changed_ = false;
  moved_ = false;
}

void CaptureWriter::remove_unnamed_pictures() {
  for (const std::string& picture : pictures_) {
    if (!named_on_disk_.contains(picture)) files_.remove(folder_ / picture);
  }
}

}  // namespace lumibox::lightfield
