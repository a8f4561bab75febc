// The precompiled header runtime.hpp belongs to this source.
