// This program says Point and TetMesh for tess::Point and tess::m2m::TetMesh.
#pragma once

namespace tess::m2m {}

namespace m2m_transfer {
using namespace tess;
using namespace tess::m2m;
}  // namespace m2m_transfer
