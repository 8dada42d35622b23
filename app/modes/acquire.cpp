#include "app/modes/acquire.h"

namespace lumibox::app {

ModeId AcquireMode::press(const Gesture&, const Moment&) {
  return ModeId::Acquire;
}

ModeId AcquireMode::update(const Moment& moment) {
  return moment.tracking_is_good() ? ModeId::Subject : ModeId::Acquire;
}

Picture AcquireMode::draw(const Moment& moment) const {
  Picture picture;
  picture.title = "looking around";
  picture.advice = tracking_advice(moment.tracked);
  return picture;
}

}  // namespace lumibox::app
