#pragma once

#include "outline/drawing/view_matrix.h"

#include <bandvox/outline/outline_options.h>
#include <bandvox/source/bezier_patch.h>

#include <openvdb/Types.h>

#include <array>
#include <vector>

namespace bandvox {

/// What a page is to show.
struct PageContent {
    std::vector<openvdb::Vec3d> framed;            ///< fills the page if the view is fitted, world
    std::vector<std::array<double, 4>> enclosing;  ///< all lies within these, homogeneous, w > 0
};

/// The content that patches are.
PageContent contentOf(const std::vector<BezierPatch>& patches);

/// The camera that sees a content.
Camera pageCamera(const PageContent& content, const OutlineOptions& options);

/// The direction to the light of `options`, world, length 1.
std::array<double, 3> lightDirection(const PageContent& content, const OutlineOptions& options);

/// The view of a content on a page, whose depths span as much as its longer side, turned by `turn`
/// radians, so that nothing is seen exactly edge-on or from its axis. Throws
/// Error(ErrorKind::Usage) if some of it reaches behind the eye.
ViewMatrix pageView(const PageContent& content, const OutlineOptions& options, double turn);

/// The view of patches on a page, whose depths span as much as its longer side. It is turned by a
/// trifle, so that nothing is seen exactly edge-on or from its axis: contours move by no more than
/// the square of that. Throws Error(ErrorKind::Usage) if a patch reaches behind the eye.
ViewMatrix pageView(const std::vector<BezierPatch>& patches, const OutlineOptions& options);

}  // namespace bandvox
