// In wheels: versions of functions that libraries of 2021 have (glibc 2.34, libstdc++ of GCC 11),
// where the linker would take newer ones. They do the same: the newer hypot only lacks error
// handling of System V, and the newer wait is not noexcept.
#include <cstdlib>  // defines __GLIBC__

#if defined(__GLIBC__) && defined(__x86_64__)

// Declared under names that no header has, and hidden, so that each library has its own.
#define MW_HIDDEN(symbol) __asm__(symbol) __attribute__((visibility("hidden")))

__asm__(".symver older_hypot, hypot@GLIBC_2.2.5");
extern "C" double older_hypot(double x, double y);
extern "C" double newer_hypot(double x, double y) MW_HIDDEN("hypot");
double newer_hypot(double x, double y) { return older_hypot(x, y); }

// std::condition_variable::wait(std::unique_lock<std::mutex>&)
#define MW_WAIT "_ZNSt18condition_variable4waitERSt11unique_lockISt5mutexE"
__asm__(".symver older_wait, " MW_WAIT "@GLIBCXX_3.4.11");
extern "C" void older_wait(void* condition, void* lock);
extern "C" void newer_wait(void* condition, void* lock) MW_HIDDEN(MW_WAIT);
void newer_wait(void* condition, void* lock) { older_wait(condition, lock); }

#endif
