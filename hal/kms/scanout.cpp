#include "hal/kms/scanout.h"

#include <algorithm>

#include "config/log.h"

namespace lumibox::hal::kms {
namespace {

/// Between two looks at what is plugged in, or two tries to become master: long for the kernel,
/// short for a person with a plug in the hand.
constexpr std::int64_t kLookEvery_ns = 1'000'000'000;

/// No screen is slower than this; a flip that takes longer is not going to happen.
constexpr std::int64_t kPatience_ns = 1'000'000'000;

}  // namespace

Scanout::Scanout(Card& card, Terminal* terminal, Buffers& buffers, const Clock& clock,
                 const std::optional<ModeWish>& wish, const Output& output)
    : card_(card),
      terminal_(terminal),
      buffers_(buffers),
      clock_(clock),
      wish_(wish),
      output_(output),
      next_look_ns_(clock.now_ns() + kLookEvery_ns) {}

void Scanout::present() {
  serve_terminal();
  const bool still_fits = look_again();
  if (state_ != State::Showing || !still_fits) {
    if (!overdue_) ++presented_;
    return;
  }
  const std::optional<std::uint32_t> next = buffers_.finish();
  if (!next) return;
  if (mode_due_) {
    start(*next);
  } else {
    follow(*next);
  }
}

void Scanout::serve_terminal() {
  if (terminal_ == nullptr) return;
  switch (terminal_->take_request()) {
    case Terminal::Request::None:
      break;
    case Terminal::Request::Leave:
      await_flip();
      card_.drop_master();
      terminal_->let_go();
      switched_away_ = true;
      stop(State::NotMaster, "another console has the screen");
      break;
    case Terminal::Request::Return:
      terminal_->take_back();
      switched_away_ = false;
      next_look_ns_ = clock_.now_ns();
      break;
  }
}

/// Now and then: whether the screen is still there, or there again. False if buffers became other
/// ones, so that what was drawn is gone.
bool Scanout::look_again() {
  if (clock_.now_ns() < next_look_ns_) return true;
  next_look_ns_ = clock_.now_ns() + kLookEvery_ns;
  if (state_ == State::Showing) {
    if (!still_connected()) stop(State::NoScreen, "the screen was unplugged");
    return true;
  }
  if (switched_away_) return true;
  if (state_ == State::NotMaster && !card_.take_master()) return true;
  return find_screen();
}

bool Scanout::still_connected() const {
  const auto connectors = card_.connectors(Probe::No);
  return std::ranges::any_of(connectors, [&](const Connector& connector) {
    return connector.id == output_.pipe.connector && connector.connected;
  });
}

bool Scanout::find_screen() {
  state_ = State::NoScreen;  // so that being master is not tried for again
  if (std::ranges::none_of(card_.connectors(Probe::No), &Connector::connected)) return true;
  const auto output = choose_output(card_.connectors(Probe::Yes), wish_);
  if (!output) return true;
  const bool fits = output->mode.size == output_.mode.size;
  output_ = *output;
  state_ = State::Showing;
  mode_due_ = true;
  if (!fits) {
    release_all();
    buffers_.resize(output_.mode.size);
  }
  return fits;
}

void Scanout::start(std::uint32_t next) {
  const Outcome outcome = card_.set_mode(output_.pipe, output_.mode, next);
  if (outcome != Outcome::Done) {
    buffers_.release(next);
    stop(outcome);
    return;
  }
  release_all();  // whatever was to be flipped to, the new mode begins with another picture
  on_screen_ = next;
  mode_due_ = false;
  overdue_ = false;
  ++presented_;
  if (stopped_) {
    config::log_info("display: pictures are shown again, at " + output_.name + " in " +
                     name_of(output_.mode));
  }
  stopped_ = false;
}

void Scanout::follow(std::uint32_t next) {
  await_flip();
  const Outcome outcome = card_.flip(output_.pipe, next, ++serial_);
  if (outcome != Outcome::Done) {
    buffers_.release(next);
    stop(outcome);
    return;
  }
  end_flip();  // taken, so the one before is over even if nobody said so
  pending_ = Flip{next, serial_};
}

void Scanout::await_flip() {
  if (!pending_) return;
  const std::int64_t deadline_ns = clock_.now_ns() + (overdue_ ? 0 : kPatience_ns);
  // What comes first may be of a flip before the mode was set.
  while (const auto ended =
             card_.wait_for_flip(std::max<std::int64_t>(0, deadline_ns - clock_.now_ns()))) {
    if (*ended != pending_->serial) continue;
    end_flip();
    overdue_ = false;
    ++presented_;
    return;
  }
  if (!overdue_) config::log_warning("display: a page flip does not end; going on without waiting");
  overdue_ = true;
}

/// What was flipped to is on the screen now, and what was there before is free.
void Scanout::end_flip() {
  if (!pending_) return;
  if (on_screen_) buffers_.release(*on_screen_);
  on_screen_ = pending_->framebuffer;
  pending_.reset();
}

void Scanout::release_all() {
  end_flip();
  if (on_screen_) buffers_.release(*on_screen_);
  on_screen_.reset();
}

void Scanout::stop(Outcome outcome) {
  if (outcome == Outcome::NotMaster) {
    stop(State::NotMaster, overdue_ ? "the graphics card is stuck in the flip before"
                                    : "another program has the graphics card");
  } else {
    stop(State::NoScreen, "the screen takes no picture");
  }
}

void Scanout::stop(State state, const std::string& why) {
  state_ = state;
  mode_due_ = true;
  next_look_ns_ = clock_.now_ns() + kLookEvery_ns;
  if (!stopped_) config::log_warning("display: " + why + "; pictures are dropped");
  stopped_ = true;
}

}  // namespace lumibox::hal::kms
