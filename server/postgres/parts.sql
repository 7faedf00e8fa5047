-- Version 3: reports of several devices, which render their parts one after the other.
ALTER TABLE jobs ADD COLUMN labels text[] NOT NULL DEFAULT '{}'; -- of the workers that may run it now; none: all
ALTER TABLE jobs ADD COLUMN parts integer NOT NULL DEFAULT 0; -- how many it has; 0 if it is not of several devices
ALTER TABLE jobs ADD COLUMN parts_ended integer NOT NULL DEFAULT 0;
ALTER TABLE jobs ADD COLUMN part text NOT NULL DEFAULT ''; -- the label of the one that runs

UPDATE jobs SET labels = ARRAY[label] WHERE label <> '';
ALTER TABLE jobs DROP COLUMN label;

-- The parts that have ended, until they are joined.
CREATE TABLE parts (
    report_id text COLLATE "C" NOT NULL REFERENCES reports (id) ON DELETE CASCADE,
    label text COLLATE "C" NOT NULL,
    sha256 text, -- of the text of what it rendered
    packed bytea, -- this text (JSON), compressed; null if it failed
    error_title text,
    error_detail text,
    PRIMARY KEY (report_id, label),
    CHECK ((packed IS NULL) = (error_title IS NOT NULL)),
    CHECK ((packed IS NULL) = (sha256 IS NULL))
);
ALTER TABLE parts ALTER packed SET STORAGE EXTERNAL;
