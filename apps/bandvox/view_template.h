#pragma once

#include <string_view>

namespace bandvox::app {

/// The page of `bandvox view` without a volume, HTML. scripts/build-view-page makes it of what is
/// in apps/view_page.
std::string_view viewTemplate();

}  // namespace bandvox::app
