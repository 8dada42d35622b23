#pragma once

#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hal/kms/drm_commit.h"
#include "hal/kms/output.h"

namespace lumibox::hal::kms {

/// A card of /dev/dri.
class DrmCard : public Card {
 public:
  explicit DrmCard(File file);

  /// Puts back what every screen showed before it was ours.
  ~DrmCard() override;

  std::vector<Connector> connectors(Probe probe) override;
  Outcome set_mode(const Pipe& pipe, const Mode& mode, std::uint32_t framebuffer) override;
  Outcome flip(const Pipe& pipe, std::uint32_t framebuffer, std::uint64_t serial) override;
  std::optional<std::uint64_t> wait_for_flip(std::int64_t timeout_ns) override;
  bool take_master() override;
  void drop_master() override;

  int descriptor() const { return file_.descriptor(); }

  /// Formats of pixels (fourcc) that this pipe shows.
  std::vector<std::uint32_t> formats(const Pipe& pipe) const;

 private:
  struct Before {
    std::uint32_t connector;
    DrmCrtc crtc;
  };

  std::vector<std::uint32_t> crtcs_of(const drmModeRes& resources,
                                      const drmModeConnector& connector) const;
  void remember(const Pipe& pipe);
  void read_events();

  File file_;
  std::unique_ptr<DrmCommit> commit_;
  std::vector<Before> before_;
  std::deque<std::uint64_t> ended_flips_;
};

struct OpenCard {
  std::unique_ptr<DrmCard> card;
  std::string path;
  Output output;
};

/// The card named, or the first with a screen; see choose_card(). Throws config::InputError.
OpenCard open_card(const std::string& asked_for, const std::optional<ModeWish>& wish);

}  // namespace lumibox::hal::kms
