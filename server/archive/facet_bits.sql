-- Version 11: which reports have several facets, without looking each of them up. A report has a slot, and every 1024 slots are
-- a block: of each facet a bit for each slot, and the places of all slots. Slots are given in the order in which reports come,
-- so they mostly grow with the places, but an import may be older than the reports before it.
ALTER TABLE search_lines ADD COLUMN slot INTEGER NOT NULL DEFAULT 0;
UPDATE search_lines SET slot = number FROM (SELECT place AS at, row_number() OVER (ORDER BY place) - 1 AS number FROM search_lines)
    WHERE place = at;
CREATE UNIQUE INDEX search_lines_by_slot ON search_lines (slot);

CREATE TABLE search_blocks (
    block INTEGER PRIMARY KEY,
    oldest INTEGER NOT NULL, -- the least and the greatest place in it
    newest INTEGER NOT NULL,
    places BLOB NOT NULL -- 8 bytes for each slot, the lowest first; 0 for an empty one
) STRICT;

CREATE TABLE facet_bits (
    facet INTEGER NOT NULL REFERENCES facets (id),
    block INTEGER NOT NULL,
    bits BLOB NOT NULL, -- 128 bytes, not all of them 0
    PRIMARY KEY (facet, block)
) STRICT, WITHOUT ROWID;

CREATE TRIGGER search_lines_placed AFTER INSERT ON search_lines
BEGIN
    INSERT INTO search_blocks VALUES (NEW.slot / 1024, NEW.place, NEW.place, sheer_with_place(x'', NEW.slot % 1024, NEW.place))
        ON CONFLICT (block) DO UPDATE SET oldest = min(oldest, excluded.oldest), newest = max(newest, excluded.newest),
        places = sheer_with_place(places, NEW.slot % 1024, NEW.place);
END;

-- Before, since the bits of the facets are found by the slot.
CREATE TRIGGER search_lines_leaving BEFORE DELETE ON search_lines
BEGIN
    DELETE FROM report_facets WHERE place = OLD.place;
    UPDATE search_blocks SET places = sheer_with_place(places, OLD.slot % 1024, 0) WHERE block = OLD.slot / 1024;
    UPDATE search_blocks SET oldest = sheer_oldest(places), newest = sheer_newest(places) WHERE block = OLD.slot / 1024;
    DELETE FROM search_blocks WHERE block = OLD.slot / 1024 AND newest = 0;
END;

CREATE TRIGGER report_facets_marked AFTER INSERT ON report_facets
BEGIN
    INSERT INTO facet_bits SELECT NEW.facet, slot / 1024, sheer_with_bit(x'', slot % 1024, 1) FROM search_lines
        WHERE place = NEW.place
        ON CONFLICT (facet, block) DO UPDATE SET bits =
        sheer_with_bit(bits, (SELECT slot FROM search_lines WHERE place = NEW.place) % 1024, 1);
END;

CREATE TRIGGER report_facets_unmarked AFTER DELETE ON report_facets
BEGIN
    UPDATE facet_bits SET bits = sheer_with_bit(bits, (SELECT slot FROM search_lines WHERE place = OLD.place) % 1024, 0)
        WHERE facet = OLD.facet AND block = (SELECT slot FROM search_lines WHERE place = OLD.place) / 1024;
    DELETE FROM facet_bits WHERE facet = OLD.facet AND bits = zeroblob(128)
        AND block = (SELECT slot FROM search_lines WHERE place = OLD.place) / 1024;
END;
