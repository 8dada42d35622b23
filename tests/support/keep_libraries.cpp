// For the sanitizers: libraries stay loaded to the end. An allocation of a graphics driver that EGL
// has unloaded could not be told by its library's name any more, which is how lsan.supp knows it.
extern "C" int dlclose(void* /*handle*/) {
  return 0;
}
