-- From version 2 of the archive to version 3: what is recorded about attempts that failed.
ALTER TABLE reports ADD COLUMN setbacks INTEGER NOT NULL DEFAULT 0; -- how often the disk refused it
ALTER TABLE reports ADD COLUMN not_before_ms INTEGER NOT NULL DEFAULT 0; -- when a queued job is due
ALTER TABLE reports ADD COLUMN lacks_room INTEGER NOT NULL DEFAULT 0; -- whether it waits for room on the disk
ALTER TABLE reports ADD COLUMN died_of INTEGER; -- the signal that ended its last renderer

CREATE INDEX reports_that_died ON reports (spec_sha256, died_of) WHERE died_of IS NOT NULL;
CREATE INDEX reports_set_back ON reports (not_before_ms) WHERE status = 'queued' AND not_before_ms > 0;
