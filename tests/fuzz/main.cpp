// The program of `./dev fuzz`: libFuzzer changes inputs of the target that SHEER_FUZZ_TARGET names.
#include <cstdint>
#include <cstdio>
#include <cstdlib>

#include "tests/fuzz/target.h"

namespace {

const sheer::test::FuzzTarget& chosen_target() {
    static const std::vector<sheer::test::FuzzTarget> targets = sheer::test::make_fuzz_targets();
    const char* wanted = std::getenv("SHEER_FUZZ_TARGET");
    for (const auto& target : targets)
        if (wanted && target.id == wanted) return target;
    std::fputs("SHEER_FUZZ_TARGET must be one of:", stderr);
    for (const auto& target : targets) std::fprintf(stderr, " %s", target.id.c_str());
    std::fputs("\n", stderr);
    std::exit(2);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    static const sheer::test::FuzzTarget& target = chosen_target();
    target.read({reinterpret_cast<const char*>(bytes), size});
    return 0;
}
