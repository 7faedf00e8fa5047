#pragma once
#include <map>
#include <string>

#include "renderer/pictures/blob_sink.h"
#include "renderer/report/report.h"

namespace sheer {

/// Keeps what it is given.
class MapSink : public BlobSink {
  public:
    std::map<std::string, std::string> bytes_by_name;
    std::string put(const std::string&, const std::string& bytes, const std::string& name,
                    const std::string&) override {
        bytes_by_name[name] = bytes;
        return "there/" + name;
    }
};

}  // namespace sheer
