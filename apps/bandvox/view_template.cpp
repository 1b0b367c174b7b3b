#include "view_template.h"

// The assembler takes the file in as it is: as an array of C++ it would take the compiler long.
asm(R"(
    .pushsection .rodata
    .type bandvoxViewPage, @object
bandvoxViewPage:
    .incbin ")" BANDVOX_VIEW_PAGE R"("
    .size bandvoxViewPage, . - bandvoxViewPage
    .type bandvoxViewPageEnd, @object
bandvoxViewPageEnd:
    .byte 0
    .size bandvoxViewPageEnd, 1
    .globl bandvoxViewPage
    .globl bandvoxViewPageEnd
    .hidden bandvoxViewPage
    .hidden bandvoxViewPageEnd
    .popsection
)");

extern "C" {
[[gnu::visibility("hidden")]] extern const char bandvoxViewPage[];
[[gnu::visibility("hidden")]] extern const char bandvoxViewPageEnd[];
}

namespace bandvox::app {

std::string_view viewTemplate() {
    return {bandvoxViewPage, static_cast<std::size_t>(bandvoxViewPageEnd - bandvoxViewPage)};
}

}  // namespace bandvox::app
