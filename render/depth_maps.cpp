#include "render/depth_maps.h"

#include <algorithm>
#include <exception>
#include <string>
#include <utility>

#include "config/log.h"

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
  const std::lock_guard lock(mutex_);
  if (auto known = find(job, false)) return known;
  if (!thread_.joinable()) {
    keep(job, estimate(job.perspectives, focus));
    return entries_.back().map;
  }
  auto older = find(job, true);
  const auto is_asked_for = [&](const Job& other) {
    return same_photos(other.perspectives, job.perspectives);
  };
  if (current_ && is_asked_for(*current_)) return older;
  std::erase_if(jobs_, is_asked_for);
  if (jobs_.size() == kMaxJobs) jobs_.erase(jobs_.begin());
  jobs_.push_back(std::move(job));
  changed_.notify_all();
  return older;
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

void DepthMaps::keep(const Job& job, std::shared_ptr<const DepthMap> map) {
  if (entries_.size() == kMaxMaps) entries_.erase(entries_.begin());
  Entry entry;
  for (const Perspective& p : job.perspectives) entry.photos.push_back(p.photo);
  entry.map = std::move(map);
  entries_.push_back(std::move(entry));
}

void DepthMaps::run() {
  std::unique_lock lock(mutex_);
  while (true) {
    changed_.wait(lock, [this] { return stopping_ || !jobs_.empty(); });
    if (stopping_) return;
    current_ = std::move(jobs_.back());
    jobs_.pop_back();
    lock.unlock();
    std::shared_ptr<const DepthMap> map;
    try {
      map = estimate(current_->perspectives, current_->focus);
    } catch (const std::exception& exception) {
      config::log_error(std::string("no depth map: ") + exception.what());
    }
    lock.lock();
    // A map that could not be made is not asked for again and again.
    keep(*current_, std::move(map));
    current_.reset();
  }
}

}  // namespace lumibox::render
