#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include "hal/clock.h"
#include "hal/kms/card.h"
#include "hal/kms/output.h"
#include "hal/kms/terminal.h"

namespace lumibox::hal::kms {

/// The buffers that pictures are drawn into, all of the screen's size.
class Buffers {
 public:
  virtual ~Buffers() = default;

  /// Completes the picture that was drawn; the KMS framebuffer with it, which is not drawn into
  /// again until it is released. None if the picture is lost.
  virtual std::optional<std::uint32_t> finish() = 0;
  virtual void release(std::uint32_t framebuffer) = 0;

  /// New ones of another size; all are released before.
  virtual void resize(Size size) = 0;
};

/// The way of finished pictures to the screen, and what may happen to it meanwhile: it is
/// unplugged, another one is plugged in, another program takes the card, somebody switches to
/// another console. None of these is an error: pictures are dropped until there is somebody to see
/// them.
class Scanout {
 public:
  /// All but `terminal`, which may be null, must outlive this. The wish is for later screens;
  /// `output` is the first. The program must be the card's master.
  Scanout(Card& card, Terminal* terminal, Buffers& buffers, const Clock& clock,
          const std::optional<ModeWish>& wish, const Output& output);

  /// Shows the picture that was drawn, or drops it. Submits it and returns, unless the one before
  /// is not on the screen yet: then waits for that, but not longer than a second. A driver without
  /// vertical blanks does not make it wait.
  void present();

  /// Whether pictures are shown now, and not dropped.
  bool showing() const { return state_ == State::Showing; }

  /// Pictures that came on the screen or that nobody could have seen; does not grow while the card
  /// shows none though it should.
  std::int64_t presented() const { return presented_; }

  Size size() const { return output_.mode.size; }

 private:
  enum class State {
    Showing,
    NoScreen,  ///< unplugged, or it takes no picture
    NotMaster  ///< another program or console has the card
  };
  struct Flip {
    std::uint32_t framebuffer;
    std::uint64_t serial;
  };

  void serve_terminal();
  bool look_again();
  bool still_connected() const;
  bool find_screen();
  void start(std::uint32_t next);
  void follow(std::uint32_t next);
  void await_flip();
  void end_flip();
  void release_all();
  void stop(Outcome outcome);
  void stop(State state, const std::string& why);

  Card& card_;
  Terminal* terminal_;
  Buffers& buffers_;
  const Clock& clock_;
  std::optional<ModeWish> wish_;
  Output output_;
  State state_ = State::Showing;
  bool switched_away_ =
      false;              ///< to another console: nothing to be tried until it is switched back
  bool mode_due_ = true;  ///< the next picture switches the screen on
  bool overdue_ = false;  ///< flips do not end: no more waiting for them until one does
  bool stopped_ = false;  ///< it was said that no pictures are shown
  std::optional<std::uint32_t> on_screen_;
  std::optional<Flip> pending_;
  std::uint64_t serial_ = 0;
  std::int64_t next_look_ns_;
  std::int64_t presented_ = 0;
};

}  // namespace lumibox::hal::kms
