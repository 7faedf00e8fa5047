-- From version 1 of the archive to version 2: uploaded files that specs refer to. Their bytes are files in a folder of
-- their own, named by their SHA-256; reports neither keep nor remove them.
CREATE TABLE assets (
    sha256 TEXT PRIMARY KEY NOT NULL,
    type TEXT NOT NULL,
    media_type TEXT NOT NULL,
    name TEXT NOT NULL,
    size_bytes INTEGER NOT NULL,
    created_ms INTEGER NOT NULL,
    facts TEXT NOT NULL -- what its check found (JSON object)
) STRICT;
