-- Version 4: the reports that were accepted for others to be compared with. Such a report cannot be deleted.
CREATE TABLE baselines (
    name TEXT NOT NULL,
    report_id TEXT NOT NULL REFERENCES reports (id) ON DELETE RESTRICT,
    accepted_ms INTEGER NOT NULL,
    accepted_by TEXT NOT NULL,
    reason TEXT NOT NULL,
    PRIMARY KEY (name, report_id)
) STRICT, WITHOUT ROWID;

CREATE INDEX baselines_by_report ON baselines (report_id);
