#include "server/process/child_message.h"

#include <cmath>

#include "tests/fuzz/target.h"

namespace sheer::test {

namespace {

/// A line of a process that renders what others sent.
void read_line(std::string_view input) {
    const ChildMessage message = read_child_message(std::string(input));
    if (const auto* progress = std::get_if<ChildProgress>(&message))
        require(progress->fraction >= 0 && progress->fraction <= 1, "progress outside 0 to 1");
}

}  // namespace

FuzzTarget fuzz_child_message() {
    return {"child_message", read_line};
}

}  // namespace sheer::test
