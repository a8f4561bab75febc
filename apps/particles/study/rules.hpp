// The study's part on rules: each by itself, step by step, against what exact distances to the
// triangles give. Serial; private to the study.
#pragma once

#include "apps/particles/simulation/field_making.hpp"
#include "apps/particles/study/measure.hpp"

namespace particles {

/// Names as in scene files.
[[nodiscard]] std::string name_of(tess::dn::Method method);
[[nodiscard]] std::string name_of(tess::dn::LookUp look_up);

/// Impact without loss, and nothing else.
[[nodiscard]] tess::dn::Rules impact_alone(tess::dn::LookUp look_up, tess::dn::Sweep sweep);

/// Rows of all rules and steps in the object's own field.
void study_rules(const Subject& subject, const StudyOptions& options, const BuiltField& built,
                 std::vector<StudyRow>& rows);

}  // namespace particles
