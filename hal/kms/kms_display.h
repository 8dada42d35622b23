#pragma once

#include <memory>
#include <optional>
#include <string>

#include "hal/clock.h"
#include "hal/display.h"
#include "hal/kms/mode.h"
#include "hal/kms/rotation.h"

namespace lumibox::hal {

struct KmsOptions {
  std::string card;                              ///< /dev/dri/card0; empty: the first with a screen
  std::optional<kms::ModeWish> mode;             ///< none: the one that the screen prefers
  kms::Rotation rotation = kms::Rotation::None;  ///< of pictures on the panel, clockwise
};

/// The screen of the box itself, without a desktop: the kernel's mode setting (KMS), buffers from
/// GBM, OpenGL ES 3 drawing into them. Pictures change at the vertical blank, so they never tear,
/// and present() waits only for the picture before the last. While the screen is unplugged, another
/// program has the card, or another console is shown, pictures are dropped, and come back by
/// themselves. A screen of another size that is plugged in later shows pictures of the first size,
/// scaled. What was shown before is shown again afterwards.
class KmsDisplay : public Display {
 public:
  /// Switches the screen on, black. `clock` must outlive this. Throws config::InputError that names
  /// the card and what is missing: permission, the mode; and config::Unavailable if that is the
  /// card, because another program has it or there is none, or a screen.
  KmsDisplay(const KmsOptions& options, const Clock& clock);
  ~KmsDisplay() override;

  int width() const override;
  int height() const override;
  void make_current() override;
  unsigned framebuffer() const override;
  void present() override;
  std::int64_t presented() const override;
  bool lost() const override;
  void renew() override;

 private:
  class Impl;
  std::unique_ptr<Impl> impl_;
};

}  // namespace lumibox::hal
