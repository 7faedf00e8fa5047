#include "server/http/zip.h"

#include <algorithm>
#include <array>
#include <limits>

namespace sheer::http {

namespace {

constexpr std::size_t piece_bytes = std::size_t{1} << 16;

class TextContent : public Content {
  public:
    explicit TextContent(std::string text) : m_text(std::move(text)) {}
    std::uint64_t size_bytes() const override { return m_text.size(); }
    void read(std::uint64_t offset, std::span<char> bytes) const override {
        m_text.copy(bytes.data(), bytes.size(), offset);
    }

  private:
    std::string m_text;
};

/// Contents one after the other.
class JoinedContent : public Content {
  public:
    void add(ContentPtr part) {
        m_begins.push_back(m_size);
        m_size += part->size_bytes();
        m_parts.push_back(std::move(part));
    }
    std::uint64_t size_bytes() const override { return m_size; }
    void read(std::uint64_t offset, std::span<char> bytes) const override {
        auto at = static_cast<std::size_t>(std::ranges::upper_bound(m_begins, offset) - m_begins.begin()) - 1;
        for (; !bytes.empty(); ++at) {
            const std::uint64_t inner = offset - m_begins.at(at);
            const std::uint64_t there = m_parts[at]->size_bytes() - inner;
            const auto count = static_cast<std::size_t>(std::min<std::uint64_t>(there, bytes.size()));
            if (count > 0) m_parts[at]->read(inner, bytes.first(count));
            bytes = bytes.subspan(count);
            offset += count;
        }
    }

  private:
    std::vector<std::uint64_t> m_begins;
    std::vector<ContentPtr> m_parts;
    std::uint64_t m_size = 0;
};

std::array<std::uint32_t, 256> make_crc_table() {
    std::array<std::uint32_t, 256> table{};
    for (std::uint32_t byte = 0; byte < 256; ++byte) {
        std::uint32_t crc = byte;
        for (int bit = 0; bit < 8; ++bit) crc = crc & 1 ? crc >> 1 ^ 0xedb88320u : crc >> 1;
        table[byte] = crc;
    }
    return table;
}

std::uint32_t crc_of(const Content& content) {
    static const std::array<std::uint32_t, 256> table = make_crc_table();
    std::uint32_t crc = 0xffffffffu;
    std::string piece(piece_bytes, '\0');
    for (std::uint64_t at = 0; at < content.size_bytes(); at += piece_bytes) {
        piece.resize(static_cast<std::size_t>(std::min<std::uint64_t>(piece_bytes, content.size_bytes() - at)));
        content.read(at, piece);
        for (const char byte : piece) crc = crc >> 8 ^ table[(crc ^ static_cast<unsigned char>(byte)) & 0xff];
    }
    return ~crc;
}

/// Numbers with their lowest byte first.
class Record {
  public:
    Record& two(std::uint32_t value) { return put(value, 2); }
    Record& four(std::uint32_t value) { return put(value, 4); }
    Record& text(const std::string& value) {
        m_bytes += value;
        return *this;
    }
    const std::string& bytes() const { return m_bytes; }

  private:
    Record& put(std::uint32_t value, int count) {
        for (int i = 0; i < count; ++i) m_bytes += static_cast<char>(value >> 8 * i & 0xff);
        return *this;
    }

    std::string m_bytes;
};

/// The fields that a file's header and its entry in the directory share (APPNOTE.TXT 4.3.7 and 4.3.12).
void put_facts(Record& record, const ZipEntry& entry, std::uint32_t crc) {
    constexpr std::uint32_t version = 20, utf8_names = 0x800, stored = 0, midnight = 0, first_of_1980 = 0x21;
    const auto size = static_cast<std::uint32_t>(entry.content->size_bytes());
    record.two(version).two(utf8_names).two(stored).two(midnight).two(first_of_1980).four(crc).four(size).four(size);
    record.two(static_cast<std::uint32_t>(entry.name.size())).two(0);
}

}  // namespace

ContentPtr content_of(std::string text) {
    return std::make_shared<TextContent>(std::move(text));
}

ContentPtr zip_of(std::vector<ZipEntry> entries) {
    auto zip = std::make_shared<JoinedContent>();
    Record directory;
    for (ZipEntry& entry : entries) {
        if (zip->size_bytes() + entry.content->size_bytes() > std::numeric_limits<std::uint32_t>::max() / 2)
            throw StoreError("the report is too large for a ZIP file");
        const std::uint32_t crc = crc_of(*entry.content);
        directory.four(0x02014b50).two(20);
        put_facts(directory, entry, crc);
        directory.two(0).two(0).two(0).four(0).four(static_cast<std::uint32_t>(zip->size_bytes())).text(entry.name);
        Record header;
        header.four(0x04034b50);
        put_facts(header, entry, crc);
        zip->add(content_of(header.text(entry.name).bytes()));
        zip->add(std::move(entry.content));
    }
    const auto count = static_cast<std::uint32_t>(entries.size());
    Record end;
    end.four(0x06054b50).two(0).two(0).two(count).two(count);
    end.four(static_cast<std::uint32_t>(directory.bytes().size())).four(static_cast<std::uint32_t>(zip->size_bytes()));
    end.two(0);
    zip->add(content_of(directory.bytes() + end.bytes()));
    return zip;
}

}  // namespace sheer::http
