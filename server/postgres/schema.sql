-- The store in PostgreSQL, version 1. Times are milliseconds since 1970 UTC. Everything is in the schema "sheer".
CREATE SCHEMA IF NOT EXISTS sheer;

CREATE TABLE store (
    program text NOT NULL PRIMARY KEY CHECK (program = 'sheer transparency'),
    version integer NOT NULL
);

INSERT INTO store VALUES ('sheer transparency', 0);

-- The database's time. Tests set it.
CREATE FUNCTION now_ms() RETURNS bigint LANGUAGE sql STABLE AS $$
SELECT coalesce(nullif(current_setting('sheer.now_ms', true), '')::bigint,
    floor(extract(epoch FROM clock_timestamp()) * 1000)::bigint)
$$;

CREATE FUNCTION refuse_change() RETURNS trigger LANGUAGE plpgsql AS $$
BEGIN
    RAISE EXCEPTION 'a final report does not change';
END
$$;

-- A report, from the moment it is queued. Ids grow with time, so their order is the order of creation. What changes while it
-- is queued or running is in `jobs`, in rows without long values and indexes, of which a heartbeat makes new versions cheaply.
CREATE TABLE reports (
    id text COLLATE "C" PRIMARY KEY,
    created_ms bigint NOT NULL,
    status text CHECK (status IN ('done', 'failed', 'cancelled')), -- null as long as there is a job
    progress double precision NOT NULL DEFAULT 0 CHECK (progress BETWEEN 0 AND 1),
    revision bigint NOT NULL DEFAULT 0,
    finished_ms bigint,
    title text NOT NULL,
    scene text NOT NULL,
    methods text[] NOT NULL, -- ids, in the order of the spec
    tags text NOT NULL, -- JSON object
    spec_sha256 text NOT NULL,
    spec text NOT NULL,
    idempotency_key text UNIQUE,
    body_sha256 text,
    error_title text,
    error_detail text,
    verdict text NOT NULL DEFAULT '',
    device text NOT NULL DEFAULT '', -- the renderer of a done report
    preview text, -- image object (JSON)
    died_of integer, -- the signal that ended its last renderer
    facets text[] NOT NULL, -- kind and values with chr(31) between them
    words tsvector NOT NULL, -- of the title and the tags' values
    CHECK ((status IS NULL) = (finished_ms IS NULL)),
    CHECK ((status = 'failed') = (error_title IS NOT NULL))
);

CREATE INDEX reports_by_status ON reports (status, id);
CREATE INDEX reports_by_facet ON reports USING gin (facets);
CREATE INDEX reports_by_word ON reports USING gin (words);
CREATE INDEX reports_that_died ON reports (spec_sha256, died_of) WHERE died_of IS NOT NULL;
CREATE TRIGGER reports_final BEFORE UPDATE ON reports FOR EACH ROW WHEN (OLD.status IS NOT NULL)
    EXECUTE FUNCTION refuse_change();

CREATE TABLE jobs (
    report_id text COLLATE "C" PRIMARY KEY REFERENCES reports (id) ON DELETE CASCADE,
    status text NOT NULL DEFAULT 'queued' CHECK (status IN ('queued', 'running')),
    progress double precision NOT NULL DEFAULT 0 CHECK (progress BETWEEN 0 AND 1),
    stage text NOT NULL DEFAULT '',
    revision bigint NOT NULL DEFAULT 1,
    attempts integer NOT NULL DEFAULT 0,
    lease_owner text,
    lease_until_ms bigint,
    cancel_requested boolean NOT NULL DEFAULT false,
    setbacks integer NOT NULL DEFAULT 0, -- how often the disk refused it
    not_before_ms bigint NOT NULL DEFAULT 0, -- when a queued job is due
    lacks_room boolean NOT NULL DEFAULT false, -- whether it waits for room on the disk
    label text NOT NULL DEFAULT '', -- of the workers that may run it; '' for all
    CHECK ((status = 'running') = (lease_owner IS NOT NULL))
) WITH (fillfactor = 50, autovacuum_vacuum_scale_factor = 0.05);

-- No index has a column that a heartbeat changes.
CREATE INDEX jobs_waiting ON jobs (report_id) WHERE status = 'queued';
CREATE INDEX jobs_running ON jobs (report_id) WHERE status = 'running';

-- Finished reports, compressed, in a table of their own, so that lists do not read them.
CREATE TABLE documents (
    report_id text COLLATE "C" PRIMARY KEY REFERENCES reports (id) ON DELETE CASCADE,
    sha256 text NOT NULL, -- of its text
    packed bytea NOT NULL -- its text (JSON), compressed
);
ALTER TABLE documents ALTER packed SET STORAGE EXTERNAL;
CREATE TRIGGER documents_final BEFORE UPDATE ON documents FOR EACH ROW EXECUTE FUNCTION refuse_change();

-- Pictures, which are compressed already.
CREATE TABLE blobs (
    sha256 text COLLATE "C" PRIMARY KEY,
    media_type text NOT NULL,
    size_bytes bigint NOT NULL,
    bytes bytea NOT NULL
);
ALTER TABLE blobs ALTER bytes SET STORAGE EXTERNAL;

CREATE TABLE report_blobs (
    report_id text COLLATE "C" NOT NULL REFERENCES reports (id) ON DELETE CASCADE,
    sha256 text COLLATE "C" NOT NULL REFERENCES blobs (sha256),
    PRIMARY KEY (report_id, sha256)
);
CREATE INDEX report_blobs_by_blob ON report_blobs (sha256);

CREATE TABLE assets (
    sha256 text COLLATE "C" PRIMARY KEY,
    type text NOT NULL,
    media_type text NOT NULL,
    name text NOT NULL,
    size_bytes bigint NOT NULL,
    created_ms bigint NOT NULL,
    place bigserial, -- in the order of their arrival
    facts text NOT NULL, -- what its check found (JSON object)
    bytes bytea NOT NULL
);
ALTER TABLE assets ALTER bytes SET STORAGE EXTERNAL;
CREATE INDEX assets_by_time ON assets (created_ms, place);

CREATE TABLE baselines (
    name text COLLATE "C" NOT NULL,
    report_id text COLLATE "C" NOT NULL REFERENCES reports (id) ON DELETE RESTRICT,
    accepted_ms bigint NOT NULL,
    accepted_by text NOT NULL,
    reason text NOT NULL,
    PRIMARY KEY (name, report_id)
);
CREATE INDEX baselines_by_report ON baselines (report_id);

-- Reports that are kept, whatever the rules for removing old ones say.
CREATE TABLE pins (
    report_id text COLLATE "C" PRIMARY KEY REFERENCES reports (id) ON DELETE RESTRICT,
    pinned_ms bigint NOT NULL,
    pinned_by text NOT NULL,
    reason text NOT NULL
);

-- The numbers of the reports, from which trends are made without reading the reports.
CREATE TABLE number_names (
    id bigserial PRIMARY KEY,
    sha256 text NOT NULL UNIQUE,
    names text NOT NULL -- JSON
);

CREATE TABLE report_numbers (
    report_id text COLLATE "C" PRIMARY KEY REFERENCES reports (id) ON DELETE CASCADE,
    names bigint NOT NULL REFERENCES number_names (id),
    numbers bytea NOT NULL -- compressed
);
CREATE INDEX report_numbers_by_names ON report_numbers (names);

-- What is counted for /metrics. Each connection adds to one of several rows of a name, so that workers do not wait for each
-- other's transactions.
CREATE TABLE counters (
    name text NOT NULL, -- kind and value with chr(31) between them
    part integer NOT NULL,
    value double precision NOT NULL,
    PRIMARY KEY (name, part)
) WITH (fillfactor = 50);

-- When a worker last rendered something, in parts for the same reason.
CREATE TABLE health (
    part integer PRIMARY KEY,
    last_rendered_ms bigint NOT NULL
) WITH (fillfactor = 50);

-- The workers that were seen lately.
CREATE TABLE workers (
    name text PRIMARY KEY,
    label text NOT NULL,
    driver text NOT NULL,
    seen_ms bigint NOT NULL
) WITH (fillfactor = 50);
