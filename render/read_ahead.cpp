#include "render/read_ahead.h"

#include <algorithm>
#include <utility>

namespace lumibox::render {

void ReadAhead::want(const Pictures& pictures) {
  std::vector<Wish> wishes;  // the old ones, whose pixels go when this ends, outside the lock
  for (const auto& picture : pictures) wishes.push_back({picture, false, nullptr});
  {
    const std::lock_guard lock(mutex_);
    for (Wish& wish : wishes) {
      if (const Wish* known = wish_for(wish.picture)) wish = *known;
    }
    std::swap(wishes, wishes_);
  }
  changed_.notify_all();
}

bool ReadAhead::read_next() {
  std::unique_lock lock(mutex_);
  Wish* wish = next();
  if (wish == nullptr) return false;
  wish->taken_on = true;
  const auto picture = wish->picture;
  lock.unlock();
  auto pixels = picture->rgb();
  lock.lock();
  // Meanwhile it may no longer be wanted.
  wish = wish_for(picture);
  if (wish != nullptr) wish->pixels = std::move(pixels);
  return true;
}

bool ReadAhead::wait() {
  std::unique_lock lock(mutex_);
  changed_.wait(lock, [this] { return stopping_ || next() != nullptr; });
  return !stopping_;
}

void ReadAhead::stop() {
  {
    const std::lock_guard lock(mutex_);
    stopping_ = true;
  }
  changed_.notify_all();
}

ReadAhead::Wish* ReadAhead::next() {
  const auto kept =
      std::ranges::count_if(wishes_, [](const Wish& w) { return w.pixels != nullptr; });
  if (static_cast<std::size_t>(kept) >= kMostKept) return nullptr;
  const auto wish = std::ranges::find(wishes_, false, &Wish::taken_on);
  return wish == wishes_.end() ? nullptr : &*wish;
}

ReadAhead::Wish* ReadAhead::wish_for(const std::shared_ptr<const lightfield::Photo>& picture) {
  const auto wish = std::ranges::find(wishes_, picture, &Wish::picture);
  return wish == wishes_.end() ? nullptr : &*wish;
}

ReadAheadThread::ReadAheadThread()
    : thread_([this] {
        while (pictures_.wait()) pictures_.read_next();
      }) {}

ReadAheadThread::~ReadAheadThread() {
  pictures_.stop();
  thread_.join();
}

}  // namespace lumibox::render
