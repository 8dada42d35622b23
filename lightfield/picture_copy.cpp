#include "lightfield/picture_copy.h"

#include "config/input_file.h"
#include "hal/image_io.h"
#include "lightfield/transforms.h"

namespace lumibox::lightfield {

std::vector<Perspective> copy_pictures(const Capture& capture, const std::filesystem::path& folder,
                                       int jpeg_quality, const DurableFiles& files) {
  files.make_folder(folder / kImagesFolder);
  std::vector<Perspective> perspectives = capture.light_field.perspectives();
  for (Perspective& perspective : perspectives) {
    const std::filesystem::path original = perspective.file;
    const bool copy = !capture.folder.empty() && !original.empty();
    perspective.file = picture_file(perspective.id, copy ? original.extension().string() : ".jpg");
    files.write(folder / perspective.file,
                copy ? config::read_bytes(capture.folder / original)
                     : hal::encode_jpeg(*perspective.photo->require_rgb(), jpeg_quality));
  }
  return perspectives;
}

}  // namespace lumibox::lightfield
