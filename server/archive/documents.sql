-- Version 5: finished reports are compressed, in a table of their own, so that lists do not read them. reports.report is
-- '' from now on if the report is done.
CREATE TABLE documents (
    report_id TEXT PRIMARY KEY NOT NULL REFERENCES reports (id) ON DELETE CASCADE,
    sha256 TEXT NOT NULL, -- of its text
    packed BLOB NOT NULL -- its text (JSON), compressed
) STRICT;

DROP TRIGGER reports_final;

INSERT INTO documents SELECT id, sheer_sha256(report), sheer_pack(report) FROM reports WHERE report IS NOT NULL;

UPDATE reports SET report = '' WHERE report IS NOT NULL;

CREATE TRIGGER reports_final BEFORE UPDATE ON reports WHEN OLD.finished_ms IS NOT NULL
BEGIN
    SELECT RAISE(ABORT, 'a final report does not change');
END;

CREATE TRIGGER documents_final BEFORE UPDATE ON documents
BEGIN
    SELECT RAISE(ABORT, 'a final report does not change');
END;
