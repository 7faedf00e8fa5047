#pragma once

namespace sheer {

// How the programs end; docs/command-line.md explains the codes.

inline constexpr int exit_ok = 0;
inline constexpr int exit_check_failed = 1;
inline constexpr int exit_bad_spec = 2;
inline constexpr int exit_render_failed = 3;
inline constexpr int exit_unreachable = 4;  ///< the server cannot be reached
inline constexpr int exit_undecided = 5;    ///< a check stayed undecided, and the spec says that this counts
/// A child process whose program could not be started; shells use the same code.
inline constexpr int exit_not_started = 127;
/// Plus the number of the signal that ended it.
inline constexpr int exit_by_signal = 128;

}  // namespace sheer
