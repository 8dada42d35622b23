#include "lightfield/capture.h"
#include "lightfield/colmap.h"
#include "lightfield/durable_files.h"
#include "lightfield/picture_copy.h"
#include "lightfield/points_file.h"
#include "lightfield/transforms.h"

namespace lumibox::lightfield {

void export_capture(const Capture& capture, ExportFormat format,
                    const std::filesystem::path& folder, int jpeg_quality) {
  const DurableFiles files;
  make_new_folder(files, folder);
  const std::vector<Perspective> perspectives = copy_pictures(capture, folder, jpeg_quality, files);
  switch (format) {
    case ExportFormat::Nerfstudio:
      if (!capture.points.empty()) files.write(folder / kPointsFile, encode_ply(capture.points));
      files.write(
          folder / kTransformsFile,
          transforms_json(perspectives, {std::nullopt, std::nullopt, !capture.points.empty()},
                          OwnKeys::Without));
      break;
    case ExportFormat::Colmap:
      write_colmap(perspectives, capture.points, folder, files);
      break;
  }
}

}  // namespace lumibox::lightfield
