// What reduced kernels and stressors (kernels/defects) are given.
#ifndef TETRACE_KERNELS_LAYOUTS_DEFECT_WORDS_H
#define TETRACE_KERNELS_LAYOUTS_DEFECT_WORDS_H

#define DEFECT_WORD_COUNT 64u // the words 0, 1, ... that they read; the number of items follows
#define FAR_END_WORD 65u      // of a kernel with a large buffer: the word with the number of that buffer's words
#define LOCAL_WORDS 257u      // memory of a work group: a word, and two for each of 128 items
#define FAR_ROOM 1048576u     // words of a large buffer after a fixed boundary: one for each item of a launch

#endif
