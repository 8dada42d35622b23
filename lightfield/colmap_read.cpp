#include <algorithm>
#include <map>

#include "config/error.h"
#include "lightfield/camera_io.h"
#include "lightfield/colmap.h"
#include "lightfield/colmap_parts.h"
#include "lightfield/picture_path.h"
#include "lightfield/text_numbers.h"
#include "lightfield/transforms.h"

namespace lumibox::lightfield {
namespace {

namespace fs = std::filesystem;

bool is_file(const fs::path& path) {
  std::error_code error;
  return fs::is_regular_file(path, error);
}

/// The folder of the model's own files. COLMAP itself prefers the binary ones, so do we.
fs::path find_model(const fs::path& folder) {
  for (const char* place : {".", "sparse/0", "sparse"}) {
    const fs::path model = folder / place;
    if (is_file(model / "cameras.bin") || is_file(model / "cameras.txt")) {
      return model.lexically_normal();
    }
  }
  throw config::InputError(folder,
                           "holds neither a transforms.json nor a COLMAP model (cameras.bin or "
                           "cameras.txt, here or in sparse/0 or sparse)");
}

/// Of the usual places, from the model outwards, the one that has the most of the pictures.
fs::path find_pictures(const fs::path& folder, const fs::path& model,
                       const std::vector<std::string>& names) {
  fs::path best = folder / kImagesFolder;
  std::ptrdiff_t most = 0;
  for (const fs::path& place :
       {folder / kImagesFolder, folder, model / kImagesFolder, model, model / ".." / kImagesFolder,
        model / ".." / ".." / kImagesFolder}) {
    const std::ptrdiff_t found = std::count_if(
        names.begin(), names.end(), [&](const std::string& name) { return is_file(place / name); });
    if (found > most) {
      most = found;
      best = place;
    }
  }
  return best.lexically_normal();
}

/// Two poses of one picture contradict each other.
void refuse_same_picture(const fs::path& file, const std::vector<ColmapImage>& images) {
  std::map<fs::path, std::string> seen;
  for (const ColmapImage& image : images) {
    const auto [earlier, is_new] =
        seen.emplace(fs::path(image.name).lexically_normal(), image.name);
    if (is_new) continue;
    throw config::InputError(file, "images \"" + printable(earlier->second) + "\" and \"" +
                                       printable(image.name) + "\" are one picture");
  }
}

}  // namespace

ColmapModel read_colmap(const fs::path& folder) {
  const fs::path place = find_model(folder);
  const bool binary = is_file(place / "cameras.bin");
  ColmapParts parts = binary ? read_colmap_binary(place) : read_colmap_text(place);
  const fs::path images_file = place / (binary ? "images.bin" : "images.txt");
  // The order in the file is COLMAP's order of registration; by name is the order of recording.
  std::sort(parts.images.begin(), parts.images.end(),
            [](const ColmapImage& a, const ColmapImage& b) { return a.name < b.name; });

  ColmapModel model;
  model.points = std::move(parts.points);
  CameraPool cameras;
  std::vector<std::string> names;
  for (const ColmapImage& image : parts.images) {
    const auto camera = parts.cameras.find(image.camera_id);
    if (camera == parts.cameras.end()) {
      throw config::InputError(images_file, "image \"" + printable(image.name) + "\" has camera " +
                                                std::to_string(image.camera_id) +
                                                ", which is not in the model");
    }
    if (!stays_inside(image.name)) {
      throw config::InputError(images_file, "image \"" + printable(image.name) +
                                                "\", expected a path inside the folder");
    }
    Perspective perspective;
    perspective.id = static_cast<int>(names.size());
    perspective.file = image.name;
    perspective.camera = cameras.get(camera->second);
    perspective.world_from_camera = image.camera_from_world.inverse();
    model.perspectives.push_back(std::move(perspective));
    names.push_back(image.name);
  }
  refuse_same_picture(images_file, parts.images);
  model.pictures_folder = find_pictures(folder, place, names);
  require_pictures(images_file, model.pictures_folder, names);
  return model;
}

}  // namespace lumibox::lightfield
