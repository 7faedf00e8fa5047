#pragma once
#include "server/archive/sqlite_archive.h"
#include "server/jobs/pins.h"

namespace sheer {

class SqlitePins : public Pins {
  public:
    explicit SqlitePins(SqliteArchive& archive) : m_archive(archive) {}
    Pinning pin(const Pin& pin) override;
    std::optional<Pin> find(const std::string& report_id) override;
    bool unpin(const std::string& report_id) override;

  private:
    SqliteArchive& m_archive;
};

}  // namespace sheer
