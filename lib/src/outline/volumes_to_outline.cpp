#include "outline/drawing/draw_curves.h"
#include "outline/volumes/volume_drawing.h"

#include <bandvox/outline/volumes_to_outline.h>

namespace bandvox {

Outline volumesToOutline(const std::vector<OutlineVolume>& volumes, const PatchModel& patches,
                         const OutlineOptions& options, Progress& progress) {
    requireValid(options);
    requireFinite(patches);
    const VolumeDrawing drawing(volumes, patches, options, progress);
    Outline outline = drawCurves(drawing.curves(), drawing.scene(), options, progress);
    outline.objects = patches.objects;
    for (const OutlineVolume& volume : volumes) outline.objects.push_back(volume.name);
    outline.warnings = patches.warnings;
    return outline;
}

}  // namespace bandvox
