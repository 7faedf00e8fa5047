#pragma once

/// The absolute path of the checkout that the tests were built from. A function in a file of its own: as a macro it
/// would be in every test's command line, and no two checkouts could share a compiler cache.
const char* source_folder();
