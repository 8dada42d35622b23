#include "config/error.h"
#include "lightfield/capture.h"
#include "lightfield/colmap.h"
#include "lightfield/points_file.h"
#include "lightfield/subject_guess.h"
#include "lightfield/transforms.h"

namespace lumibox::lightfield {
namespace {

namespace fs = std::filesystem;

/// A data set as read: poses and names, pictures still on disk.
struct Source {
  fs::path folder;  ///< pictures' files are relative to it
  std::vector<Perspective> perspectives;
  std::vector<Eigen::Vector3d> points;
  std::optional<Sphere> subject;
};

Source read_nerfstudio(const fs::path& file) {
  Transforms transforms = read_transforms(file, Dialect::Foreign);
  Source source;
  source.folder = file.parent_path();
  if (transforms.points_file) source.points = read_ply(source.folder / *transforms.points_file);
  source.perspectives = std::move(transforms.perspectives);
  source.subject = transforms.subject;
  return source;
}

Source read_source(const fs::path& path) {
  std::error_code error;
  if (!fs::exists(path, error)) throw config::InputError(path, "there is no such file or folder");
  if (!fs::is_directory(path, error)) return read_nerfstudio(path);
  if (fs::exists(path / kTransformsFile, error)) return read_nerfstudio(path / kTransformsFile);
  ColmapModel model = read_colmap(path);
  return {model.pictures_folder, std::move(model.perspectives), std::move(model.points), {}};
}

}  // namespace

Capture import_capture(const fs::path& path, const PointFinder& find_points) {
  Source source = read_source(path);
  if (source.perspectives.empty()) throw config::InputError(path, "holds no pictures");
  for (Perspective& perspective : source.perspectives) {
    perspective.photo =
        std::make_shared<Photo>(source.folder / perspective.file, *perspective.camera);
  }
  if (source.points.empty() && find_points) source.points = find_points(source.perspectives);
  if (!source.subject) source.subject = guess_subject(source.perspectives, source.points);
  Capture capture;
  // "." because empty means that there are no originals.
  capture.folder = source.folder.empty() ? "." : source.folder;
  capture.points = std::move(source.points);
  capture.light_field = LightField(std::move(source.perspectives), source.subject);
  return capture;
}

}  // namespace lumibox::lightfield
