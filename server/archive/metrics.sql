-- Version 9: what is counted for /metrics: leases that were lost, and the seconds that jobs spent in each stage.
CREATE TABLE counters (
    name TEXT PRIMARY KEY NOT NULL, -- kind and value with char(31) between them
    value REAL NOT NULL
) STRICT, WITHOUT ROWID;
