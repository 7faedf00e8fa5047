-- Version 8: the numbers of the reports, from which trends are made without reading the reports.
CREATE TABLE number_names (
    id INTEGER PRIMARY KEY,
    names TEXT NOT NULL UNIQUE -- JSON
) STRICT;

CREATE TABLE report_numbers (
    report_id TEXT PRIMARY KEY NOT NULL REFERENCES reports (id) ON DELETE CASCADE,
    names INTEGER NOT NULL REFERENCES number_names (id),
    numbers BLOB NOT NULL, -- compressed
    seal TEXT NOT NULL
) STRICT;

CREATE INDEX report_numbers_by_names ON report_numbers (names);

CREATE VIEW sealed_report_numbers AS
SELECT report_id, sheer_seal(report_id, number_names.names, numbers) AS seal
FROM report_numbers JOIN number_names ON number_names.id = report_numbers.names;
