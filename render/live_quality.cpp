#include "render/live_quality.h"

#include <algorithm>
#include <exception>
#include <string>
#include <utility>

#include "config/log.h"
#include "config/step_back.h"
#include "geometry/robust.h"

namespace lumibox::render {
namespace {

using lightfield::Perspective;

/// True if nothing that a judgement comes from differs.
bool same(const Perspective& a, const Perspective& b) {
  return a.id == b.id && a.photo == b.photo &&
         a.world_from_camera.translation == b.world_from_camera.translation &&
         a.world_from_camera.rotation.coeffs() == b.world_from_camera.rotation.coeffs();
}

}  // namespace

LiveQuality::LiveQuality(const config::Render& render, const config::Quality& quality,
                         Estimating estimating)
    : estimating_(estimating), docket_(render, quality) {
  if (estimating == Estimating::Meanwhile) thread_ = std::thread([this] { run(); });
}

LiveQuality::~LiveQuality() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

const CaptureQuality& LiveQuality::watch(const lightfield::LightField& light_field,
                                         const Points& points) {
  bool is_news = see(light_field);
  if (is_news) {
    if (points) seen_.points = points();
    pending_ = Seen{seen_};
  }
  if (estimating_ == Estimating::AtOnce) {
    if (pending_) take(*pending_);
    pending_.reset();
    if (docket_.judge_next() || is_news) {
      findings_ = {docket_.rulings(), tuned_};
      is_news = true;
    }
  } else {
    is_news = exchange() || is_news;
  }
  if (is_news) tell();
  quality_.gains = eased_gains_.step(gains_);
  return quality_;
}

/// The light field that is judged from now on.
void LiveQuality::take(const Seen& seen) {
  docket_.set(seen.perspectives, seen.subject);
  const std::vector<Perspective>& thumbnails = docket_.thumbnails();
  const std::vector<double> gains = exposure_.gains(thumbnails, seen.subject.center, seen.points);
  tuned_.clear();
  auto original = seen.perspectives.begin();
  for (std::size_t i = 0; i < thumbnails.size(); ++i) {
    original =
        std::ranges::find(original, seen.perspectives.end(), thumbnails[i].id, &Perspective::id);
    tuned_.push_back({original->id, original->photo, gains[i]});
  }
}

/// True if the light field is not what was seen last.
bool LiveQuality::see(const lightfield::LightField& light_field) {
  static const std::vector<Perspective> kNothing;
  const lightfield::Sphere subject = light_field.subject().value_or(lightfield::Sphere{});
  const auto& perspectives = light_field.subject() ? light_field.perspectives() : kNothing;
  if (subject.center == seen_.subject.center && subject.radius == seen_.subject.radius &&
      std::ranges::equal(perspectives, seen_.perspectives, same)) {
    return false;
  }
  seen_ = {perspectives, subject, {}};
  return true;
}

/// Hands over what is pending, takes what there is. The thread may be put aside while it holds the
/// lock: then that waits for the next tick, not the tick for it. True if there was something.
bool LiveQuality::exchange() {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock) return false;
  if (pending_) {
    handed_over_ = std::exchange(pending_, std::nullopt);
    changed_.notify_all();
  }
  if (!handed_back_) return false;
  findings_ = *std::exchange(handed_back_, std::nullopt);
  return true;
}

void LiveQuality::tell() {
  quality_ = {};
  std::vector<double> all;
  auto seen = seen_.perspectives.begin();
  for (const Ruling& ruling : findings_.rulings) {
    seen = std::find_if(seen, seen_.perspectives.end(),
                        [&](const Perspective& p) { return p.id >= ruling.id; });
    if (seen == seen_.perspectives.end()) break;
    if (seen->id != ruling.id || seen->photo != ruling.picture.lock()) continue;
    quality_.psnr[ruling.id] = ruling.psnr;
    if (ruling.disagrees) quality_.disagreeing.push_back(ruling.id);
    all.push_back(ruling.psnr);
  }
  quality_.median_psnr = geometry::median(std::move(all));

  gains_.clear();
  for (const Perspective& perspective : seen_.perspectives) gains_[perspective.id] = 1.0;
  for (const TunedPicture& tuned : findings_.tuned) {
    const auto one = std::ranges::find(seen_.perspectives, tuned.id, &Perspective::id);
    if (one != seen_.perspectives.end() && one->photo == tuned.picture.lock()) {
      gains_[tuned.id] = tuned.gain;
    }
  }
}

void LiveQuality::run() {
  config::step_back("pictures are judged");
  std::unique_lock lock(mutex_);
  bool idle = true;
  while (true) {
    changed_.wait(lock, [&] { return stopping_ || handed_over_ || !idle; });
    if (stopping_) return;
    const std::optional<Seen> seen = std::exchange(handed_over_, std::nullopt);
    lock.unlock();
    std::optional<Findings> findings;
    try {
      if (seen) take(*seen);
      idle = !docket_.judge_next();
      findings = {docket_.rulings(), tuned_};
    } catch (const std::exception& exception) {
      config::log_error(std::string("pictures cannot be judged: ") + exception.what());
      idle = true;  // until something changes
    }
    lock.lock();
    if (findings) handed_back_ = std::move(findings);
  }
}

}  // namespace lumibox::render
