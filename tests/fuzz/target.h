#pragma once
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace sheer::test {

/// Code that reads what others send, and what must hold whatever that is. tests/fuzz/targets/<id>.cpp ends with
/// `FuzzTarget fuzz_<id>()`; tests/fuzz/corpus/<id> has inputs to begin with.
struct FuzzTarget {
    std::string id;
    /// Reads the input. Refusing it with the documented error is right; anything else that is thrown is a fault.
    void (*read)(std::string_view input) = nullptr;
};

/// Every target, from the generated table.
std::vector<FuzzTarget> make_fuzz_targets();

/// For what must hold. Throws std::logic_error.
inline void require(bool holds, const char* what) {
    if (!holds) throw std::logic_error(what);
}

/// The message of an error is shown to people, in terminals and logs.
inline void require_readable(std::string_view message) {
    require(!message.empty(), "an error without a message");
    for (const char c : message) require(c == '\n' || (c >= ' ' && c <= '~'), "a message that is not printable ASCII");
}

/// Reads; refusing the input by `Refusal`, with a readable message, is right as well.
template <typename Refusal, typename Read>
void read_or_refuse(const Read& read) {
    try {
        read();
    } catch (const Refusal& error) {
        require_readable(error.what());
    }
}

}  // namespace sheer::test
