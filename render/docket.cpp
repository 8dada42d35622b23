#include "render/docket.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "render/reduced.h"

namespace lumibox::render {
namespace {

using lightfield::Perspective;

bool same(const geometry::Pose& a, const geometry::Pose& b) {
  return a.translation == b.translation && a.rotation.coeffs() == b.rotation.coeffs();
}

}  // namespace

Docket::Docket(const config::Render& render, const config::Quality& quality)
    : options_(quality), judge_(render) {}

void Docket::set(const std::vector<Perspective>& perspectives, const lightfield::Sphere& subject) {
  std::vector<Perspective> thumbnails;
  std::vector<Case> cases;
  std::size_t before = 0;
  for (const Perspective& perspective : perspectives) {
    while (before < thumbnails_.size() && thumbnails_[before].id < perspective.id) ++before;
    const bool known = before < thumbnails_.size() && thumbnails_[before].id == perspective.id &&
                       cases_[before].picture.lock() == perspective.photo;
    const auto thumbnail =
        known ? std::optional(thumbnails_[before]) : reduced(perspective, kThumbnail);
    if (!thumbnail) continue;  // lost
    thumbnails.push_back(*thumbnail);
    thumbnails.back().world_from_camera = perspective.world_from_camera;
    cases.push_back(known ? std::move(cases_[before]) : Case{});
    cases.back().picture = perspective.photo;
  }
  thumbnails_ = std::move(thumbnails);
  cases_ = std::move(cases);
  if (subject.center != subject_.center || subject.radius != subject_.radius) {
    for (Case& c : cases_) c.heard.clear();
  }
  subject_ = subject;
  for (std::size_t i = 0; i < cases_.size(); ++i) {
    cases_[i].jury = jury_of(thumbnails_, i, subject_.center);
  }
}

bool Docket::judge_next() {
  if (const auto index = next_new()) {
    judge(*index);
  } else if (const auto accused = next_accused()) {
    changes(*accused) > 0 ? judge(*accused) : hear_appeal(*accused);
  } else if (const auto changed = next_changed()) {
    judge(*changed);
  } else {
    return false;
  }
  return true;
}

void Docket::hear_appeal(std::size_t index) {
  Case& c = cases_[index];
  c.judged->appeal = judge_.appeal(thumbnails_, index, c.jury.members, subject_);
}

void Docket::judge(std::size_t index) {
  Case& c = cases_[index];
  c.judged = {judge_.judge(thumbnails_, index, c.jury.members, subject_), std::nullopt,
              c.jury.nearest};
  c.heard = {{thumbnails_[index].id, thumbnails_[index].world_from_camera}};
  for (const std::size_t i : c.jury.members) {
    c.heard.push_back({thumbnails_[i].id, thumbnails_[i].world_from_camera});
  }
}

/// How many of those that the judgement should come from it did not come from.
std::size_t Docket::changes(std::size_t index) const {
  const Case& c = cases_[index];
  const auto was_heard = [&](std::size_t i) {
    return std::ranges::any_of(c.heard, [&](const Witness& witness) {
      return witness.id == thumbnails_[i].id &&
             same(witness.world_from_camera, thumbnails_[i].world_from_camera);
    });
  };
  std::size_t changes = was_heard(index) ? 0 : 1;
  for (const std::size_t i : c.jury.members) changes += was_heard(i) ? 0 : 1;
  // One that was heard is no longer there.
  return std::max(changes, c.heard.size() == c.jury.members.size() + 1 ? 0 : std::size_t{1});
}

std::optional<std::size_t> Docket::next_new() const {
  const auto found = std::ranges::find_if(cases_, [](const Case& c) { return !c.judged; });
  if (found == cases_.end()) return std::nullopt;
  return static_cast<std::size_t>(found - cases_.begin());
}

std::optional<std::size_t> Docket::next_accused() const {
  const auto limits = limits_of(judged(), options_);
  if (!limits) return std::nullopt;
  for (std::size_t i = 0; i < cases_.size(); ++i) {
    const std::optional<Judged>& judged = cases_[i].judged;
    if (!judged || !stands_out(*judged, *limits)) continue;
    if (!judged->appeal || changes(i) > 0) return i;
  }
  return std::nullopt;
}

std::optional<std::size_t> Docket::next_changed() const {
  std::optional<std::size_t> best;
  std::size_t fewest = 0;
  for (std::size_t i = 0; i < cases_.size(); ++i) {
    const std::size_t count = changes(i);
    if (count == 0 || (best && count >= fewest)) continue;
    best = i;
    fewest = count;
  }
  return best;
}

std::vector<Judged> Docket::judged() const {
  std::vector<Judged> judged;
  for (const Case& c : cases_) {
    if (c.judged) judged.push_back(*c.judged);
  }
  return judged;
}

std::vector<Ruling> Docket::rulings() const {
  const std::vector<double> severities = this->severities();
  std::vector<Ruling> rulings;
  for (std::size_t i = 0; i < cases_.size(); ++i) {
    const Case& c = cases_[i];
    if (!c.judged || std::isnan(c.judged->judgement.psnr)) continue;
    const bool is_excused = std::ranges::any_of(c.jury.members, [&](std::size_t member) {
      return severities[member] > kCause * severities[i];
    });
    const bool disagrees = severities[i] > 1.0 && !is_excused && changes(i) == 0;
    rulings.push_back({thumbnails_[i].id, c.picture, c.judged->judgement.psnr, disagrees});
  }
  return rulings;
}

/// Of all perspectives; 0 for those that are not judged.
std::vector<double> Docket::severities() const {
  std::vector<double> severities(cases_.size(), 0.0);
  const auto limits = limits_of(judged(), options_);
  for (std::size_t i = 0; limits && i < cases_.size(); ++i) {
    if (cases_[i].judged) severities[i] = severity(*cases_[i].judged, *limits);
  }
  return severities;
}

}  // namespace lumibox::render
