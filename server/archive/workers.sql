-- Version 10: the workers that were seen lately.
CREATE TABLE workers (
    name TEXT PRIMARY KEY NOT NULL,
    label TEXT NOT NULL,
    driver TEXT NOT NULL, -- the renderer of its device
    seen_ms INTEGER NOT NULL
) STRICT, WITHOUT ROWID;
