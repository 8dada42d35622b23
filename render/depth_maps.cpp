#include "render/depth_maps.h"

#include <algorithm>
#include <exception>
#include <string>
#include <utility>

#include "config/log.h"
#include "config/step_back.h"

namespace lumibox::render {
namespace {

using lightfield::Perspective;

constexpr std::size_t kMaxMaps = 512;  // 30 MB of 640x480 pictures
constexpr std::size_t kMaxJobs = 16;   // older ones belong to views long gone

std::shared_ptr<const DepthMap> estimate(const std::vector<Perspective>& perspectives,
                                         const Eigen::Vector3d& focus) {
  std::vector<const Perspective*> others;
  for (std::size_t i = 1; i < perspectives.size(); ++i) others.push_back(&perspectives[i]);
  auto map = estimate_depth(perspectives.front(), others, focus);
  return map ? std::make_shared<const DepthMap>(std::move(*map)) : nullptr;
}

bool same_photos(const std::vector<Perspective>& a, const std::vector<Perspective>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(),
                    [](const Perspective& p, const Perspective& q) { return p.photo == q.photo; });
}

}  // namespace

bool DepthMaps::Entry::is_of(const Job& job) const {
  return std::equal(
      photos.begin(), photos.end(), job.perspectives.begin(), job.perspectives.end(),
      [](const auto& photo, const Perspective& p) { return photo.lock() == p.photo; });
}

DepthMaps::DepthMaps(Estimating estimating) {
  if (estimating == Estimating::Meanwhile) thread_ = std::thread([this] { run(); });
}

DepthMaps::~DepthMaps() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
  if (thread_.joinable()) thread_.join();
}

std::shared_ptr<const DepthMap> DepthMaps::map_of(const std::vector<Perspective>& perspectives,
                                                  std::size_t index, const Eigen::Vector3d& focus) {
  Job job{{perspectives[index]}, focus};
  for (const std::size_t i : depth_neighbours(perspectives, index, focus)) {
    job.perspectives.push_back(perspectives[i]);
  }
  if (auto known = find(job, false)) return known;
  if (!thread_.joinable()) {
    keep(entry_of(job, estimate(job.perspectives, focus)));
    return entries_.back().map;
  }
  std::erase_if(
      jobs_, [&](const Job& other) { return same_photos(other.perspectives, job.perspectives); });
  if (jobs_.size() == kMaxJobs) jobs_.erase(jobs_.begin());
  jobs_.push_back(job);
  has_news_ = true;
  exchange();
  return find(job, true);
}

bool DepthMaps::complete() {
  exchange();
  return jobs_.empty();
}

/// Takes the maps that there are, hands over what else is to be made. The thread may be put aside
/// while it holds the lock: then that waits for the next time, not this for the thread.
void DepthMaps::exchange() {
  const std::unique_lock lock(mutex_, std::try_to_lock);
  if (!lock) return;
  for (Entry& entry : handed_back_) {
    std::erase_if(jobs_, [&](const Job& job) { return entry.is_of(job); });
    keep(std::move(entry));
  }
  handed_back_.clear();
  if (!std::exchange(has_news_, false)) return;
  handed_over_ = jobs_;
  changed_.notify_all();
}

/// The map of these pictures, or of the first of them with whatever neighbours.
std::shared_ptr<const DepthMap> DepthMaps::find(const Job& job, bool any_neighbours) {
  const auto known = std::find_if(entries_.rbegin(), entries_.rend(), [&](const Entry& entry) {
    return any_neighbours ? entry.photos.front().lock() == job.perspectives.front().photo
                          : entry.is_of(job);
  });
  if (known == entries_.rend()) return nullptr;
  std::rotate(known.base() - 1, known.base(), entries_.end());
  return entries_.back().map;
}

void DepthMaps::keep(Entry entry) {
  if (entries_.size() == kMaxMaps) entries_.erase(entries_.begin());
  entries_.push_back(std::move(entry));
}

DepthMaps::Entry DepthMaps::entry_of(const Job& job, std::shared_ptr<const DepthMap> map) {
  Entry entry;
  for (const Perspective& p : job.perspectives) entry.photos.push_back(p.photo);
  entry.map = std::move(map);
  return entry;
}

void DepthMaps::run() {
  config::step_back("depths are estimated");
  std::vector<Job> jobs;
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [&] { return stopping_ || handed_over_ || !jobs.empty(); });
    if (stopping_) return;
    if (handed_over_) jobs = *std::exchange(handed_over_, std::nullopt);
    if (jobs.empty()) continue;
    const Job job = std::move(jobs.back());
    jobs.pop_back();
    lock.unlock();
    std::shared_ptr<const DepthMap> map;
    try {
      map = estimate(job.perspectives, job.focus);
    } catch (const std::exception& exception) {
      config::log_error(std::string("no depth map: ") + exception.what());
    }
    // A map that could not be made is not asked for again and again.
    Entry entry = entry_of(job, std::move(map));
    lock.lock();
    if (handed_over_) std::erase_if(*handed_over_, [&](const Job& j) { return entry.is_of(j); });
    handed_back_.push_back(std::move(entry));
  }
}

}  // namespace lumibox::render
