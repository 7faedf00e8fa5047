-- Version 6: an index for searching. A report has a place: a number that grows with the time in its id, so that lists, newest
-- first, are ranges of places. It has facets, such as its scene or one of its tags; the reports of a facet are a range as well,
-- and reports with several facets are found by looking each report of the rarest one up in the others.
CREATE TABLE search_lines (
    place INTEGER PRIMARY KEY,
    report_id TEXT NOT NULL UNIQUE REFERENCES reports (id) ON DELETE CASCADE,
    device TEXT NOT NULL DEFAULT '', -- the renderer of a done report
    words TEXT NOT NULL -- of the title and the tags' values: in lower case, each once, each with a space in front
) STRICT;

CREATE TABLE facets (
    id INTEGER PRIMARY KEY,
    facet TEXT NOT NULL UNIQUE, -- kind and values with char(31) between them
    reports INTEGER NOT NULL DEFAULT 0 -- how many have it
) STRICT;

INSERT INTO facets (facet) SELECT 'status' || char(31) || value
FROM json_each('["queued", "running", "done", "failed", "cancelled"]');

CREATE TABLE report_facets (
    facet INTEGER NOT NULL REFERENCES facets (id),
    place INTEGER NOT NULL REFERENCES search_lines (place) ON DELETE CASCADE,
    PRIMARY KEY (facet, place)
) STRICT, WITHOUT ROWID;

CREATE INDEX report_facets_by_place ON report_facets (place);

CREATE TRIGGER report_facets_added AFTER INSERT ON report_facets
BEGIN
    UPDATE facets SET reports = reports + 1 WHERE id = NEW.facet;
END;

CREATE TRIGGER report_facets_removed AFTER DELETE ON report_facets
BEGIN
    UPDATE facets SET reports = reports - 1 WHERE id = OLD.facet;
END;

CREATE TRIGGER reports_status AFTER UPDATE OF status ON reports WHEN NEW.status <> OLD.status
BEGIN
    DELETE FROM report_facets WHERE facet = (SELECT id FROM facets WHERE facet = 'status' || char(31) || OLD.status)
        AND place = (SELECT place FROM search_lines WHERE report_id = NEW.id);
    INSERT INTO report_facets SELECT facets.id, place FROM facets, search_lines
        WHERE facet = 'status' || char(31) || NEW.status AND report_id = NEW.id;
END;

-- The same words by FTS5. It reads the reports of an indexed beginning of a word in order, but would have to merge those of all
-- words that begin with another one.
CREATE VIRTUAL TABLE search_words USING fts5 (
    words, content = 'search_lines', content_rowid = 'place', tokenize = 'ascii', prefix = '1 2 3 4 5 6 7 8',
    columnsize = 0, detail = none
);

CREATE TRIGGER search_lines_added AFTER INSERT ON search_lines
BEGIN
    INSERT INTO search_words (rowid, words) VALUES (NEW.place, NEW.words);
END;

CREATE TRIGGER search_lines_removed AFTER DELETE ON search_lines
BEGIN
    INSERT INTO search_words (search_words, rowid, words) VALUES ('delete', OLD.place, OLD.words);
END;
