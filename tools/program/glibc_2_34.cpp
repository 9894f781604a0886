// In wheels: the hypot of every glibc, where the linker would take that of glibc 2.35. Both compute
// the same; the newer one lacks error handling of System V alone.
#include <cstdlib>  // defines __GLIBC__

#if defined(__GLIBC__) && defined(__x86_64__)

__asm__(".symver older_hypot, hypot@GLIBC_2.2.5");
extern "C" double older_hypot(double x, double y);

// Under another name, since compilers know a hypot of their own, which is not hidden.
extern "C" __attribute__((visibility("hidden"))) double newer_hypot(double x,
                                                                    double y) __asm__("hypot");
double newer_hypot(double x, double y) { return older_hypot(x, y); }

#endif
