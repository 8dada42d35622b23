#include "render/judge.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/depth_map.h"
#include "render/image_quality.h"
#include "render/reference.h"

namespace lumibox::render {
namespace {

using lightfield::Perspective;

constexpr std::size_t kMembers = 8;  // of a jury: as many as a picture on a shape is made of
constexpr int kReachShare = 10;      // a shift is looked for up to a tenth of the subject's width
constexpr double kFeatherShare = 0.05;  // of the height: what render.feather_px is of 480 rows
constexpr double kLeastCovered = 0.5;   // of the subject, for shift and difference
constexpr int kLeastReach = 3;          // pixels

/// The perspectives with the pictures of those alone that count; indices stay.
std::vector<Perspective> only(const std::vector<Perspective>& perspectives,
                              const std::vector<std::size_t>& counted) {
  std::vector<Perspective> result = perspectives;
  for (Perspective& perspective : result) perspective.photo.reset();
  for (const std::size_t i : counted) result[i].photo = perspectives[i].photo;
  return result;
}

std::vector<std::size_t> every_other(const std::vector<std::size_t>& jury, std::size_t first) {
  std::vector<std::size_t> half;
  for (std::size_t i = first; i < jury.size(); i += 2) half.push_back(jury[i]);
  return half;
}

hal::Image cut_out(const hal::Image& image, const Box& box) {
  hal::Image part(box.width(), box.height(), image.channels());
  for (int y = 0; y < part.height(); ++y) {
    std::copy_n(image.at(box.left, box.top + y), part.stride(), part.row(y));
  }
  return part;
}

/// Where a mask is and a rendered picture shows something: what nobody covers is black, and tells
/// nothing of pose or occluders.
hal::Image where_shown(const hal::Image& picture, hal::Image mask) {
  for (int y = 0; y < picture.height(); ++y) {
    for (int x = 0; x < picture.width(); ++x) {
      const std::uint8_t* pixel = picture.at(x, y);
      if (pixel[0] == 0 && pixel[1] == 0 && pixel[2] == 0) *mask.at(x, y) = 0;
    }
  }
  return mask;
}

double count_of(const hal::Image& mask) {
  const std::uint8_t* const end = mask.data() + mask.size_bytes();
  return static_cast<double>(
      std::count_if(mask.data(), end, [](auto value) { return value != 0; }));
}

/// What of a photograph shows the subject; none if nothing does.
std::optional<Photograph> cut_to_subject(const Photograph& photograph) {
  const Box box = box_of(photograph.on_subject);
  if (box.empty()) return std::nullopt;
  config::CameraProfile profile = photograph.view.camera.profile();
  profile.cx -= box.left;
  profile.cy -= box.top;
  profile.width = box.width();
  profile.height = box.height();
  return Photograph{
      {geometry::Camera(profile), photograph.view.world_from_camera},
      {cut_out(photograph.picture.color, box), cut_out(photograph.picture.valid, box)},
      cut_out(photograph.on_subject, box)};
}

}  // namespace

Jury jury_of(const std::vector<Perspective>& perspectives, std::size_t index,
             const Eigen::Vector3d& subject) {
  Jury jury;
  for (const auto& [angle, i] :
       nearest_by_angle(perspectives, perspectives[index].center(), subject)) {
    if (i == index) continue;
    if (jury.members.empty()) jury.nearest = angle;
    jury.members.push_back(i);
    if (jury.members.size() == kMembers) break;
  }
  return jury;
}

Judge::Judge(const config::Render& options)
    : settings_(settings_from(options, Aperture::Small, Eigen::Vector3d::Zero())),
      geometry_(geometry_named(options.geometry)),
      proxy_({}, Estimating::AtOnce) {}

Judgement Judge::judge(const std::vector<Perspective>& perspectives, std::size_t index,
                       const std::vector<std::size_t>& jury, const lightfield::Sphere& subject) {
  const auto photograph = cut_to_subject(photograph_of(perspectives[index], subject));
  if (!photograph || jury.empty()) return {};
  const auto& [view, truth, on_subject] = *photograph;
  settings_.focus = subject.center;
  settings_.feather_px = kFeatherShare * perspectives[index].camera->height();
  const Settings settings = proxy_.fit(settings_, geometry_, view, perspectives, jury);
  const hal::Image picture = render_reference(view, only(perspectives, jury), settings);
  Judgement judgement;
  judgement.psnr = psnr(picture, truth.color, &on_subject);
  const hal::Image covered = where_shown(picture, on_subject);
  if (count_of(covered) < kLeastCovered * count_of(on_subject)) return judgement;
  const int reach = std::max(kLeastReach, view.camera.width() / kReachShare);
  judgement.shift =
      shift_between(truth.color, picture, covered, reach).norm() / view.camera.profile().fx;
  judgement.difference = patch_difference(picture, truth.color, covered);
  return judgement;
}

Judgement Judge::appeal(const std::vector<Perspective>& perspectives, std::size_t index,
                        const std::vector<std::size_t>& jury, const lightfield::Sphere& subject) {
  const Judgement a = judge(perspectives, index, every_other(jury, 0), subject);
  const Judgement b = judge(perspectives, index, every_other(jury, 1), subject);
  return {std::fmax(a.psnr, b.psnr), std::fmin(a.shift, b.shift),
          std::fmin(a.difference, b.difference)};
}

}  // namespace lumibox::render
