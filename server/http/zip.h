#pragma once
#include <string>
#include <vector>

#include "server/jobs/content.h"

namespace sheer::http {

/// The bytes of a text.
ContentPtr content_of(std::string text);

struct ZipEntry {
    std::string name;  ///< a relative path with /, in UTF-8
    ContentPtr content;
};

/// A ZIP file of these files, stored without compression: pictures are compressed already. Its bytes are read from the
/// files when they are asked for, so that it takes little memory; each file is read once before, for its CRC. Throws
/// StoreError, also if it would be larger than the 4 GiB of the format without extensions.
ContentPtr zip_of(std::vector<ZipEntry> entries);

}  // namespace sheer::http
