#pragma once

#include "command_line.h"
#include "option_table.h"

#include <vector>

namespace bandvox::app {

/// A command: what it says of itself, and what it does. `run` returns when all is done, and
/// throws Error or another std::exception if that fails.
struct Command {
    const CommandTable& (*table)();
    void (*run)(const CommandLine& line);
};

const CommandTable& convertTable();
void runConvert(const CommandLine& line);

const CommandTable& fitTable();
void runFit(const CommandLine& line);

const CommandTable& voxelizeTable();
void runVoxelize(const CommandLine& line);

const CommandTable& renderTable();
void runRender(const CommandLine& line);

const CommandTable& outlineTable();
void runOutline(const CommandLine& line);

const CommandTable& infoTable();
void runInfo(const CommandLine& line);

const CommandTable& compareTable();
void runCompare(const CommandLine& line);

const CommandTable& mergeTable();
void runMerge(const CommandLine& line);

const CommandTable& viewTable();
void runView(const CommandLine& line);

/// All commands, in the order in which the help lists them.
inline const std::vector<Command>& commands() {
    static const std::vector<Command> all{
        {convertTable, runConvert}, {voxelizeTable, runVoxelize}, {fitTable, runFit},
        {renderTable, runRender},   {outlineTable, runOutline},   {infoTable, runInfo},
        {compareTable, runCompare}, {mergeTable, runMerge},       {viewTable, runView}};
    return all;
}

}  // namespace bandvox::app
