#pragma once

#include <nlohmann/json.hpp>
#include <openvdb/Types.h>

#include <string>

// What the reports of the info command have in common.
namespace bandvox::app {

nlohmann::ordered_json toJson(const openvdb::Vec3d& vector);

/// A JSON value as one would say it, with control characters written out.
std::string inWords(const nlohmann::ordered_json& value);

/// A box {min, max}, or null.
std::string boundsInWords(const nlohmann::ordered_json& bounds);

/// Appends a line of a name and what is said of it.
void appendLine(std::string& out, const std::string& name, const std::string& value);

}  // namespace bandvox::app
