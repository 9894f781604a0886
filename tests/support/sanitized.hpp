// MW_SANITIZED is defined in builds under AddressSanitizer or ThreadSanitizer, which reserve
// terabytes of address space and start threads: tests that limit either leave them out.
#pragma once

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define MW_SANITIZED 1
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define MW_SANITIZED 1
#endif
#endif
