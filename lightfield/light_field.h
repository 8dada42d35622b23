#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "lightfield/perspective.h"

namespace lumibox::lightfield {

/// The penalty of thesis 3 and figure 2.2: angle A-S-B in radians, [0, pi]. 0 if A or B is S.
double angle_at_subject(const Eigen::Vector3d& a, const Eigen::Vector3d& subject,
                        const Eigen::Vector3d& b);

/// The set of recorded perspectives around one subject, with the gate of thesis 2.3 and the wipe of
/// thesis 2.4. Not thread safe; the loop owns it.
class LightField {
 public:
  LightField() = default;

  /// A stored set; the ids are kept. Precondition: they are not negative and all differ.
  LightField(std::vector<Perspective> perspectives, std::optional<Sphere> subject);

  /// In order of id, which is the order of recording.
  const std::vector<Perspective>& perspectives() const { return perspectives_; }
  const std::optional<Sphere>& subject() const { return subject_; }
  void set_subject(const Sphere& sphere) {
    subject_ = sphere;
    ++revision_;
  }

  /// Counts changes of any kind, for those who cache what they derive from it.
  std::uint64_t revision() const { return revision_; }

  /// Thesis 2.3: true if the angle at S between `center` and every recorded centre exceeds
  /// `threshold` (radians). False without a subject. Seen from S a centre at S lies in no
  /// direction: such a `center` is never accepted, and a recorded one (the sphere may be moved
  /// onto it later) covers nothing.
  bool accepts(const Eigen::Vector3d& center, double threshold) const;

  /// Adds one; its id is assigned here and returned.
  int add(Perspective perspective);

  /// Id of the perspective nearest to `center` by penalty; of several in one direction the one
  /// nearest in space. Without a subject only the distance counts. None if empty.
  std::optional<int> nearest(const Eigen::Vector3d& center) const;

  /// Removes one and remembers it for undo_wipe(); none if there is no such id.
  std::optional<Perspective> wipe(int id);

  /// Brings back the last wiped perspective, with its id and in its old place; returns it, or none
  /// if there is none left.
  std::optional<Perspective> undo_wipe();

  /// What to tell the person when pictures are lost (Photo::fault): how many, and why the first.
  /// None if none is.
  std::optional<std::string> lost_pictures() const;

  /// Moves a perspective after a correction of the map, a wiped one too; false if there is no such
  /// id.
  bool set_pose(int id, const geometry::Pose& world_from_camera);

  /// Has a perspective hang on a keyframe in another way; it moves when its pose is set. A wiped
  /// one too; false if there is no such id.
  bool hang(int id, int keyframe, const geometry::Pose& keyframe_from_camera);

 private:
  Perspective* find(int id);

  std::vector<Perspective> perspectives_;  ///< ids ascend
  std::vector<Perspective> wiped_;         ///< the last wiped one last
  std::optional<Sphere> subject_;
  std::uint64_t revision_ = 0;
  int next_id_ = 0;
};

}  // namespace lumibox::lightfield
