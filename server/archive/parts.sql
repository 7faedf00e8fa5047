-- Version 13: reports of several devices, which render their parts one after the other.
ALTER TABLE jobs ADD COLUMN labels TEXT NOT NULL DEFAULT '[]'; -- of the workers that may run it now (JSON array); none: all
ALTER TABLE jobs ADD COLUMN parts INTEGER NOT NULL DEFAULT 0; -- how many it has; 0 if it is not of several devices
ALTER TABLE jobs ADD COLUMN parts_ended INTEGER NOT NULL DEFAULT 0;
ALTER TABLE jobs ADD COLUMN part TEXT NOT NULL DEFAULT ''; -- the label of the one that runs

UPDATE jobs SET labels = (SELECT json_array(json_extract(spec, '$.device')) FROM reports WHERE id = report_id)
    WHERE (SELECT coalesce(json_extract(spec, '$.device'), '') <> '' FROM reports WHERE id = report_id);

-- The parts that have ended, until they are joined.
CREATE TABLE parts (
    report_id TEXT NOT NULL REFERENCES reports (id) ON DELETE CASCADE,
    label TEXT NOT NULL,
    sha256 TEXT, -- of the text of what it rendered
    packed BLOB, -- this text (JSON), compressed; null if it failed
    error_title TEXT,
    error_detail TEXT,
    PRIMARY KEY (report_id, label),
    CHECK ((packed IS NULL) = (error_title IS NOT NULL)),
    CHECK ((packed IS NULL) = (sha256 IS NULL))
) STRICT;

CREATE TRIGGER parts_over AFTER UPDATE OF finished_ms ON reports WHEN NEW.finished_ms IS NOT NULL
BEGIN
    DELETE FROM parts WHERE report_id = NEW.id;
END;
