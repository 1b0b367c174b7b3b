#include "report_words.h"

#include "words.h"

#include <vector>

namespace bandvox::app {

using Json = nlohmann::ordered_json;

Json toJson(const openvdb::Vec3d& vector) {
    return Json::array({vector.x(), vector.y(), vector.z()});
}

std::string inWords(const Json& value) {
    if (value.is_string()) return printable(value.get<std::string>());
    if (value.is_number_float()) return formatNumber(value.get<double>(), 8);
    if (value.is_boolean()) return value.get<bool>() ? "yes" : "no";
    if (value.is_array()) {
        std::vector<std::string> parts;
        for (const Json& part : value) parts.push_back(inWords(part));
        return "(" + joined(parts, ", ") + ")";
    }
    return value.dump();
}

std::string boundsInWords(const Json& bounds) {
    if (bounds.is_null()) return "empty";
    return inWords(bounds["min"]) + " to " + inWords(bounds["max"]);
}

void appendLine(std::string& out, const std::string& name, const std::string& value) {
    constexpr std::size_t kNameWidth = 16;
    out += "  " + name;
    out += std::string(name.size() < kNameWidth ? kNameWidth - name.size() : 1, ' ');
    out += value + '\n';
}

}  // namespace bandvox::app
