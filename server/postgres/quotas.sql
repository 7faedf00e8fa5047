-- Version 2: what waits and runs, by the tokens with which it was sent, and what their holders took up.
ALTER TABLE jobs ADD COLUMN token text NOT NULL DEFAULT ''; -- its name
ALTER TABLE jobs ADD COLUMN cost_mpx double precision NOT NULL DEFAULT 0;

-- In parts, like `counters`.
CREATE TABLE token_use (
    token text NOT NULL,
    hour bigint NOT NULL, -- since 1970 UTC
    part integer NOT NULL,
    seconds double precision NOT NULL DEFAULT 0, -- of rendering
    upload_bytes bigint NOT NULL DEFAULT 0,
    PRIMARY KEY (token, hour, part)
) WITH (fillfactor = 50);
