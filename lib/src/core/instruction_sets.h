#pragma once

// Put before a function, has it compiled for several instruction sets, one of which is chosen when
// the program starts. The sanitizers' runtimes are not ready yet at that moment.
#if defined(__x86_64__) && defined(__GNUC__) && !defined(__clang__) && \
    !defined(__SANITIZE_THREAD__) && !defined(__SANITIZE_ADDRESS__)
#define BANDVOX_FOR_EACH_INSTRUCTION_SET \
    __attribute__((target_clones("arch=x86-64-v4", "arch=x86-64-v3", "default")))
#else
#define BANDVOX_FOR_EACH_INSTRUCTION_SET
#endif
