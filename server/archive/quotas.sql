-- Version 12: what waits and runs, by the tokens with which it was sent, and what their holders took up.
CREATE TABLE jobs (
    report_id TEXT PRIMARY KEY NOT NULL REFERENCES reports (id) ON DELETE CASCADE,
    token TEXT NOT NULL, -- its name, or ''
    cost_mpx REAL NOT NULL
) STRICT, WITHOUT ROWID;

INSERT INTO jobs SELECT id, '', 0 FROM reports WHERE finished_ms IS NULL;

CREATE TRIGGER jobs_over AFTER UPDATE OF finished_ms ON reports WHEN NEW.finished_ms IS NOT NULL
BEGIN
    DELETE FROM jobs WHERE report_id = NEW.id;
END;

CREATE TABLE token_use (
    token TEXT NOT NULL,
    hour INTEGER NOT NULL, -- since 1970 UTC
    seconds REAL NOT NULL DEFAULT 0, -- of rendering
    upload_bytes INTEGER NOT NULL DEFAULT 0,
    PRIMARY KEY (token, hour)
) STRICT, WITHOUT ROWID;
