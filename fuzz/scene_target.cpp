// What users write by hand: scenes in JSON, and files of options.

#include "config_file.h"
#include "fuzz_input.h"
#include "option_table.h"
#include "scene_file.h"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    using namespace bandvox;
    static const fuzz::InputFile file(fuzz::extension(".json"));
    static const bool isScene = fuzz::extension(".json") == ".json";
    static const std::vector<std::string> kNames{"file",  "color", "iso",    "res",
                                                 "scale", "turn",  "shadows"};
    static const app::CommandTable kTable{
        "convert", "", "", {}, {{"order", 0, "N", "2", "", ""}, {"clamp", 0, "", "", "", ""}}, {}};
    const std::filesystem::path& path = file.write(data, size);
    fuzz::mayRefuse([&] {
        if (!isScene) {
            app::readConfigFile(path, kTable);
            return;
        }
        const app::SceneFile scene(path);
        for (const char* list : {"objects", "lights"}) scene.list(list, kNames);
        for (const char* group : {"environment", "picture", "camera"}) scene.group(group, kNames);
    });
    return 0;
}
