// Whether this build runs under the address sanitizer, some ten times slower: tests of statistics over many trials,
// whose code smaller tests run as well, are left to the other builds.
#pragma once

namespace textonbench {

#ifdef __SANITIZE_ADDRESS__
constexpr bool sanitized = true;
#else
constexpr bool sanitized = false;
#endif

}  // namespace textonbench
