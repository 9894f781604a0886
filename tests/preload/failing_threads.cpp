// To be preloaded (LD_PRELOAD): from the FAILING_THREAD-th thread on none can be started.
#include <dlfcn.h>
#include <pthread.h>

#include <atomic>
#include <cerrno>
#include <cstdlib>

extern "C" int pthread_create(pthread_t* thread, const pthread_attr_t* attributes,
                              void* (*work)(void*), void* argument) noexcept {
  using Create = int (*)(pthread_t*, const pthread_attr_t*, void* (*)(void*), void*);
  static const auto create = reinterpret_cast<Create>(dlsym(RTLD_NEXT, "pthread_create"));
  static const char* const first = std::getenv("FAILING_THREAD");
  static std::atomic<int> count = 0;
  if (first != nullptr && ++count >= std::atoi(first)) return EAGAIN;
  return create(thread, attributes, work, argument);
}
