// Oracles of the convex hull: enumeration, nothing clever.
#pragma once

#include <vector>

#include <glm/vec3.hpp>

namespace varve::reference {

/// Largest t with g + t d inside the hull of the points, by looking at every one, two and three of them (the face that
/// the segment leaves through has at most three corners). Points that miss it by `slack` count as hit.
double exit_by_faces(const std::vector<glm::dvec3>& points, const glm::dvec3& g, const glm::dvec3& d, double slack);

/// The same for points each widened to a small triangle of radius `eta` across d: the dual linear program, min over
/// planes through three corners that lie above all others. Has an answer whatever the points.
double exit_by_planes(const std::vector<glm::dvec3>& points, const glm::dvec3& g, const glm::dvec3& d, double eta);

/// The point of the hull nearest to h, by looking at every one, two and three of the points; h itself when inside.
glm::dvec3 nearest_by_faces(const std::vector<glm::dvec3>& points, const glm::dvec3& h);

}  // namespace varve::reference
