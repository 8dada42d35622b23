#include "hal/desk.h"

#include <X11/Xlib.h>
#include <X11/Xutil.h>
#include <fcntl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <cstdlib>
#include <string>

namespace lumibox::testing {
namespace {

[[noreturn]] void become_xvfb(int tell_number) {
  dup2(open("/dev/null", O_WRONLY), STDERR_FILENO);  // it tells of keys that its keyboard lacks
  execlp("Xvfb", "Xvfb", "-displayfd", std::to_string(tell_number).c_str(), "-noreset", "-nolisten",
         "tcp", "-screen", "0", "640x480x24", nullptr);
  _exit(127);
}

/// All that is written into a pipe until it is closed or a line is over.
std::string read_line(int end) {
  std::string line;
  for (char letter = 0; read(end, &letter, 1) == 1 && letter != '\n';) line += letter;
  return line;
}

void send(Display* server, Window window, XEvent event, long mask) {
  XSendEvent(server, window, False, mask, &event);
  XSync(server, False);
}

}  // namespace

Desktop::Desktop() {
  std::array<int, 2> ends{};
  if (pipe(ends.data()) != 0) return;
  server_ = fork();
  if (server_ == 0) become_xvfb(ends[1]);
  ::close(ends[1]);
  const std::string number = read_line(ends[0]);  // once it is ready; nothing if it is missing
  ::close(ends[0]);
  if (!number.empty()) setenv("DISPLAY", (":" + number).c_str(), 1);
}

Desktop::~Desktop() {
  if (server_ <= 0) return;
  kill(server_, SIGTERM);
  waitpid(server_, nullptr, 0);
}

std::unique_ptr<Desk> Desk::open() {
  Display* const server = XOpenDisplay(nullptr);
  return server == nullptr ? nullptr : std::unique_ptr<Desk>(new Desk(server));
}

Desk::~Desk() {
  XCloseDisplay(server_);
}

std::array<int, 3> Desk::color_at(int x, int y) const {
  XImage* const image = XGetImage(server_, window(), x, y, 1, 1, AllPlanes, ZPixmap);
  const unsigned long pixel = XGetPixel(image, 0, 0);
  XDestroyImage(image);
  const auto byte = [&](unsigned shift) { return static_cast<int>(pixel >> shift & 0xFFU); };
  return {byte(16), byte(8), byte(0)};
}

void Desk::resize(unsigned width, unsigned height) const {
  XResizeWindow(server_, window(), width, height);
  XSync(server_, False);
}

void Desk::type(unsigned code, bool down) const {
  constexpr unsigned kFirstKey = 8;  // X11 counts from there
  XEvent event{};
  event.xkey.type = down ? KeyPress : KeyRelease;
  event.xkey.window = window();
  event.xkey.root = DefaultRootWindow(server_);
  event.xkey.keycode = code + kFirstKey;
  send(server_, window(), event, down ? KeyPressMask : KeyReleaseMask);
}

void Desk::close() const {
  XEvent event{};
  event.xclient.type = ClientMessage;
  event.xclient.window = window();
  event.xclient.message_type = XInternAtom(server_, "WM_PROTOCOLS", False);
  event.xclient.format = 32;
  event.xclient.data.l[0] = static_cast<long>(XInternAtom(server_, "WM_DELETE_WINDOW", False));
  send(server_, window(), event, NoEventMask);
}

unsigned long Desk::window() const {
  Window root = 0;
  Window parent = 0;
  Window* children = nullptr;
  unsigned count = 0;
  XQueryTree(server_, DefaultRootWindow(server_), &root, &parent, &children, &count);
  Window found = 0;
  for (unsigned i = 0; i < count; ++i) {
    char* name = nullptr;
    if (XFetchName(server_, children[i], &name) != 0 && std::string(name) == "Lumibox") {
      found = children[i];
    }
    XFree(name);
  }
  XFree(children);
  return found;
}

}  // namespace lumibox::testing
