/// The products of errors of one method at one budget: what needs all images of the cell at once. Kept in DIR/cells, so
/// that a report from stored runs reads no images twice.
#pragma once

#include <map>
#include <string>
#include <vector>

#include <pellucid/study/statistics.h>

#include "compare_runs.h"

namespace pellucid {

struct CellProducts {
    ErrorProducts relative, absolute;
    std::map<std::string, ErrorProducts> classes;  ///< relative; those that reference and runs have as layers
};

/// Classes of which `reference` has the layers.
[[nodiscard]] std::vector<std::string> classesIn(const Image& reference);

[[nodiscard]] CellProducts cellProducts(const std::vector<const StoredRun*>& runs, const CompareReference& reference,
                                        const RunStore& store, const Workers& workers);

}  // namespace pellucid
