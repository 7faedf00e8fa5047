#pragma once
#include "server/archive/sqlite_archive.h"
#include "server/jobs/readiness.h"

namespace sheer {

class SqliteReadiness : public Readiness {
  public:
    explicit SqliteReadiness(SqliteArchive& archive) : m_archive(archive) {}
    void note_rendered() override;
    std::optional<std::int64_t> last_rendered_ms() override;
    std::string lack_of_room() override;

  private:
    SqliteArchive& m_archive;
};

}  // namespace sheer
