-- The archive, version 1. Times are milliseconds since 1970 UTC.

-- A report, from the moment it is queued. Ids grow with time, so their order is the order of creation.
CREATE TABLE reports (
    id TEXT PRIMARY KEY NOT NULL,
    status TEXT NOT NULL CHECK (status IN ('queued', 'running', 'done', 'failed', 'cancelled')),
    progress REAL NOT NULL DEFAULT 0 CHECK (progress BETWEEN 0 AND 1),
    stage TEXT NOT NULL DEFAULT '',
    revision INTEGER NOT NULL DEFAULT 1,
    created_ms INTEGER NOT NULL,
    finished_ms INTEGER,
    title TEXT NOT NULL,
    scene TEXT NOT NULL,
    spec_sha256 TEXT NOT NULL,
    error_title TEXT,
    error_detail TEXT,
    verdict TEXT,
    preview TEXT, -- image object (JSON)
    idempotency_key TEXT UNIQUE,
    body_sha256 TEXT,
    attempts INTEGER NOT NULL DEFAULT 0,
    lease_owner TEXT,
    lease_until_ms INTEGER,
    cancel_requested INTEGER NOT NULL DEFAULT 0,
    spec TEXT NOT NULL,
    report TEXT, -- the finished report (JSON)
    CHECK ((status = 'done') = (report IS NOT NULL)),
    CHECK ((status = 'failed') = (error_title IS NOT NULL)),
    CHECK ((status = 'running') = (lease_owner IS NOT NULL)),
    CHECK ((status IN ('queued', 'running')) = (finished_ms IS NULL))
) STRICT;

CREATE INDEX reports_by_status ON reports (status, id);

-- A report never changes after it is final.
CREATE TRIGGER reports_final BEFORE UPDATE ON reports WHEN OLD.finished_ms IS NOT NULL
BEGIN
    SELECT RAISE(ABORT, 'a final report does not change');
END;

CREATE TABLE report_methods (
    report_id TEXT NOT NULL REFERENCES reports (id) ON DELETE CASCADE,
    position INTEGER NOT NULL,
    method TEXT NOT NULL,
    PRIMARY KEY (report_id, position)
) STRICT, WITHOUT ROWID;

CREATE TABLE report_tags (
    report_id TEXT NOT NULL REFERENCES reports (id) ON DELETE CASCADE,
    name TEXT NOT NULL,
    value TEXT NOT NULL,
    PRIMARY KEY (report_id, name)
) STRICT, WITHOUT ROWID;

-- Pictures; their bytes are files named by their SHA-256.
CREATE TABLE blobs (
    sha256 TEXT PRIMARY KEY NOT NULL,
    media_type TEXT NOT NULL
) STRICT, WITHOUT ROWID;

CREATE TABLE report_blobs (
    report_id TEXT NOT NULL REFERENCES reports (id) ON DELETE CASCADE,
    sha256 TEXT NOT NULL REFERENCES blobs (sha256),
    PRIMARY KEY (report_id, sha256)
) STRICT, WITHOUT ROWID;

CREATE INDEX report_blobs_by_blob ON report_blobs (sha256);

-- One row: when a worker last rendered something.
CREATE TABLE health (
    id INTEGER PRIMARY KEY CHECK (id = 1),
    last_rendered_ms INTEGER NOT NULL
) STRICT;
