#include "lightfield/capture.h"

#include "config/error.h"
#include "lightfield/capture_lock.h"
#include "lightfield/picture_copy.h"
#include "lightfield/points_file.h"
#include "lightfield/transforms.h"

namespace lumibox::lightfield {

namespace fs = std::filesystem;

Capture load_capture(const fs::path& folder) {
  std::error_code error;
  if (!fs::is_directory(folder, error)) {
    throw config::InputError(folder, "is not a folder, expected a capture");
  }
  Transforms transforms = read_transforms(folder / kTransformsFile, Dialect::Capture);
  Capture capture;
  capture.folder = folder;
  capture.threshold = transforms.threshold;
  if (transforms.points_file) capture.points = read_ply(folder / *transforms.points_file);
  for (Perspective& perspective : transforms.perspectives) {
    perspective.photo = std::make_shared<Photo>(folder / perspective.file, *perspective.camera);
  }
  capture.light_field = LightField(std::move(transforms.perspectives), transforms.subject);
  return capture;
}

void save_capture(const Capture& capture, const fs::path& folder, int jpeg_quality) {
  const DurableFiles files;
  const CaptureLock lock = make_capture_folder(files, folder);
  const std::vector<Perspective> perspectives = copy_pictures(capture, folder, jpeg_quality, files);
  if (!capture.points.empty()) files.write(folder / kPointsFile, encode_ply(capture.points));
  files.write(
      folder / kTransformsFile,
      transforms_json(perspectives,
                      {capture.light_field.subject(), capture.threshold, !capture.points.empty()},
                      OwnKeys::With));
}

}  // namespace lumibox::lightfield
