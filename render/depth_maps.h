#pragma once

#include <Eigen/Core>
#include <condition_variable>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "lightfield/perspective.h"
#include "render/depth_map.h"

namespace lumibox::render {

/// When depth maps are estimated.
enum class Estimating {
  AtOnce,    ///< where they are asked for: two runs are identical
  Meanwhile  ///< on a thread of its own, which works when no other wants to: nobody waits
};

/// Depth maps of perspectives, estimated when they are first asked for and kept; those unused for
/// longest go. A map is told by the pictures that it came from, so it stays as it is when poses are
/// corrected a little, and when a perspective is recorded that would be a better neighbour it is
/// made anew.
class DepthMaps {
 public:
  explicit DepthMaps(Estimating estimating);
  ~DepthMaps();
  DepthMaps(const DepthMaps&) = delete;
  DepthMaps& operator=(const DepthMaps&) = delete;

  /// The map of a perspective; null if its picture is lost. Meanwhile: null if it is not there yet,
  /// or one of fewer neighbours. Never waits for the thread.
  std::shared_ptr<const DepthMap> map_of(const std::vector<lightfield::Perspective>& perspectives,
                                         std::size_t index, const Eigen::Vector3d& focus);

  /// True if nothing that was asked for is still to come.
  bool complete();

 private:
  /// A perspective and its neighbours: all that a map comes from.
  struct Job {
    std::vector<lightfield::Perspective> perspectives;  ///< its own first
    Eigen::Vector3d focus = Eigen::Vector3d::Zero();
  };
  struct Entry {
    std::vector<std::weak_ptr<const lightfield::Photo>> photos;  ///< of a job's perspectives
    std::shared_ptr<const DepthMap> map;

    bool is_of(const Job& job) const;
  };
  static Entry entry_of(const Job& job, std::shared_ptr<const DepthMap> map);

  void run();
  void exchange();
  std::shared_ptr<const DepthMap> find(const Job& job, bool any_neighbours);
  void keep(Entry entry);

  std::vector<Entry> entries_;  ///< used last come last
  std::vector<Job> jobs_;       ///< still to come; asked for last come last, and are done first
  bool has_news_ = false;       ///< of jobs that the thread does not know

  std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  std::optional<std::vector<Job>> handed_over_;
  std::vector<Entry> handed_back_;
  bool stopping_ = false;

  std::thread thread_;
};

}  // namespace lumibox::render
