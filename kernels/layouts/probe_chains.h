// Operations of the self-test that are chains of several, which a compiler shortens if it reassociates. Single
// operations are in layout.h.
#ifndef TETRACE_KERNELS_PROBE_CHAINS_H
#define TETRACE_KERNELS_PROBE_CHAINS_H

#define PROBE_SPLIT 9u
#define PROBE_CANCEL 10u
#define PROBE_SCALE 11u

#endif
