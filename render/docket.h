#pragma once

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <vector>

#include "config/config.h"
#include "lightfield/perspective.h"
#include "render/disagreement.h"
#include "render/judge.h"

namespace lumibox::render {

/// A judged perspective, told by its picture: ids begin anew with each capture.
struct Ruling {
  int id = 0;
  std::weak_ptr<const lightfield::Photo> picture;
  double psnr = 0.0;  ///< dB, see Judgement
  /// With those around it. Nobody is told to on evidence that has changed.
  bool disagrees = false;
};

/// What of a light field is still to be judged, in small slices. New perspectives come first: a dot
/// without a colour tells nothing, and the depth maps made for them serve those around them. Then
/// those that stand out: judged again if something has changed since, or else on appeal. Then the
/// others of which something has changed, the least first: most of what these need is there.
class Docket {
 public:
  Docket(const config::Render& render, const config::Quality& quality);

  /// The light field as it is now. What was judged and has not changed stays so.
  void set(const std::vector<lightfield::Perspective>& perspectives,
           const lightfield::Sphere& subject);

  /// Of those whose picture is there, in order of id, reduced(…, kThumbnail).
  const std::vector<lightfield::Perspective>& thumbnails() const { return thumbnails_; }

  /// Judges one perspective; false if there is nothing to do.
  bool judge_next();

  /// Of all that are judged, in order of id.
  std::vector<Ruling> rulings() const;

 private:
  /// A pose that a judgement came from.
  struct Witness {
    int id;
    geometry::Pose world_from_camera;
  };
  struct Case {
    std::weak_ptr<const lightfield::Photo> picture;  ///< as recorded
    Jury jury;
    std::optional<Judged> judged;
    std::vector<Witness> heard;  ///< for the judgement: its own, then the jury's
  };

  std::size_t changes(std::size_t index) const;
  std::optional<std::size_t> next_new() const;
  std::optional<std::size_t> next_accused() const;
  std::optional<std::size_t> next_changed() const;
  void judge(std::size_t index);
  void hear_appeal(std::size_t index);
  std::vector<Judged> judged() const;
  std::vector<double> severities() const;

  config::Quality options_;
  Judge judge_;
  lightfield::Sphere subject_;
  std::vector<lightfield::Perspective> thumbnails_;  ///< in order of id
  std::vector<Case> cases_;                          ///< of the thumbnails
};

}  // namespace lumibox::render
