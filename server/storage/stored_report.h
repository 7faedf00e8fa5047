#pragma once
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "server/jobs/parts.h"

namespace sheer {

/// The text of the done report `id` from what pack_text() made of it. Throws DamagedData if it cannot be read or has
/// another hash than `sha256`.
std::string stored_report_text(std::string_view packed, const std::string& sha256, const std::string& id);

/// What a store has written beside a report's spec and text, by which the report is found.
struct StoredRelations {
    std::vector<std::string> methods;   ///< ids, in the order of the spec
    std::vector<std::string> tags;      ///< tag_text() of each
    std::vector<std::string> pictures;  ///< picture_text() of each
};

std::string tag_text(const std::string& name, const std::string& value);
std::string picture_text(const std::string& sha256, const std::string& media_type);

/// The runs of all parts of a report that have ended, as wrong_relations() reads them.
nlohmann::json joined_runs(const std::vector<EndedPart>& parts);

/// Which of them do not agree with the report, as sentences. `report`: null if it is not done, and then its pictures
/// are not compared.
std::vector<std::string> wrong_relations(const std::string& spec, const nlohmann::json& report,
                                         const StoredRelations& stored);

}  // namespace sheer
