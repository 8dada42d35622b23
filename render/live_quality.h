#pragma once

#include <condition_variable>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <thread>
#include <vector>

#include "config/config.h"
#include "lightfield/light_field.h"
#include "render/docket.h"
#include "render/exposure.h"

namespace lumibox::render {

/// How good a capture is so far.
struct CaptureQuality {
  /// By id, of those judged: PSNR in dB of the perspective's view, made from those around it,
  /// against its own picture, on the subject (Judgement).
  std::map<int, double> psnr;
  std::vector<int> disagreeing;  ///< ids of those that do not fit those around them, ascending
  double median_psnr = 0.0;      ///< of those judged, dB; 0 if there are none
  /// By id: what makes each as bright as its neighbours (Perspective::gain), 1 where it is not
  /// known yet. They change so slowly that nothing jumps in a picture.
  std::map<int, double> gains;
};

/// Judges a light field while it is captured. Meanwhile: on a thread of its own, which works when
/// no other thread of the machine wants the processor. At once: one perspective per call.
class LiveQuality {
 public:
  using Points = std::function<std::vector<Eigen::Vector3d>()>;

  LiveQuality(const config::Render& render, const config::Quality& quality, Estimating estimating);
  ~LiveQuality();
  LiveQuality(const LiveQuality&) = delete;
  LiveQuality& operator=(const LiveQuality&) = delete;

  /// Once per tick: what the light field is now, and what is known of it. Only perspectives that it
  /// holds are judged or told of. `points` are the scene's, in world, asked for only when the light
  /// field has changed; without any, exposures are not compared. Never waits for a judgement that
  /// another thread makes.
  const CaptureQuality& watch(const lightfield::LightField& light_field, const Points& points = {});

 private:
  /// What of a light field is judged.
  struct Seen {
    std::vector<lightfield::Perspective> perspectives;
    lightfield::Sphere subject;
    std::vector<Eigen::Vector3d> points;
  };
  /// A picture and its gain; told by the picture, as a Ruling is.
  struct TunedPicture {
    int id = 0;
    std::weak_ptr<const lightfield::Photo> picture;
    double gain = 1.0;
  };
  /// What has been found out.
  struct Findings {
    std::vector<Ruling> rulings;
    std::vector<TunedPicture> tuned;
  };

  bool see(const lightfield::LightField& light_field);
  void take(const Seen& seen);
  bool exchange();
  void tell();
  void run();

  Estimating estimating_;
  Docket docket_;  ///< the thread's, if there is one, as the next two
  Exposure exposure_;
  std::vector<TunedPicture> tuned_;
  Seen seen_;                    ///< what was watched last
  std::optional<Seen> pending_;  ///< not yet handed over
  Findings findings_;            ///< the newest known, maybe of perspectives that are gone
  std::map<int, double> gains_;  ///< by id, of what was watched last
  EasedGains eased_gains_;
  CaptureQuality quality_;

  std::mutex mutex_;  // guards what follows
  std::condition_variable changed_;
  std::optional<Seen> handed_over_;
  std::optional<Findings> handed_back_;
  bool stopping_ = false;

  std::thread thread_;
};

}  // namespace lumibox::render
