-- Version 7: what the care of an archive needs. A seal is a hash of everything that a row says and that never changes again.
CREATE TABLE report_seals (
    report_id TEXT PRIMARY KEY NOT NULL REFERENCES reports (id) ON DELETE CASCADE,
    sha256 TEXT NOT NULL
) STRICT, WITHOUT ROWID;

CREATE VIEW sealed_reports AS
SELECT id AS report_id,
    sheer_seal(id, status, progress, stage, revision, created_ms, finished_ms, title, scene, reports.spec_sha256, error_title,
        error_detail, verdict, preview, idempotency_key, body_sha256, attempts, lease_owner, lease_until_ms,
        cancel_requested, spec, report, setbacks, not_before_ms, lacks_room, died_of, documents.sha256) AS sha256
FROM reports LEFT JOIN documents ON documents.report_id = id WHERE finished_ms IS NOT NULL;

INSERT INTO report_seals SELECT report_id, sha256 FROM sealed_reports;

ALTER TABLE assets ADD COLUMN seal TEXT NOT NULL DEFAULT '';
CREATE VIEW sealed_assets AS
SELECT sha256, sheer_seal(sha256, type, media_type, name, size_bytes, created_ms, facts) AS seal FROM assets;
UPDATE assets SET seal = (SELECT seal FROM sealed_assets WHERE sealed_assets.sha256 = assets.sha256);

ALTER TABLE baselines ADD COLUMN seal TEXT NOT NULL DEFAULT '';
CREATE VIEW sealed_baselines AS
SELECT name, report_id, sheer_seal(name, report_id, accepted_ms, accepted_by, reason) AS seal FROM baselines;
UPDATE baselines SET seal = (SELECT seal FROM sealed_baselines
    WHERE sealed_baselines.name = baselines.name AND sealed_baselines.report_id = baselines.report_id);

-- Reports that are kept, whatever the rules for removing old ones say.
CREATE TABLE pins (
    report_id TEXT PRIMARY KEY NOT NULL REFERENCES reports (id) ON DELETE RESTRICT,
    pinned_ms INTEGER NOT NULL,
    pinned_by TEXT NOT NULL,
    reason TEXT NOT NULL,
    seal TEXT NOT NULL DEFAULT ''
) STRICT, WITHOUT ROWID;
CREATE VIEW sealed_pins AS
SELECT report_id, sheer_seal(report_id, pinned_ms, pinned_by, reason) AS seal FROM pins;

ALTER TABLE blobs ADD COLUMN size_bytes INTEGER NOT NULL DEFAULT 0;
