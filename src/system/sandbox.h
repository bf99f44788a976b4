/* sandbox.h - what a child of the reader process gives up before it looks at a stranger's file.
   Part of the reader process alone: a library of its own, wr_sandbox.
   Belongs to one system: platform code, see src/README.md. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

/* Limit this process for good:
 *
 *   no files but those already open: no path is opened, asked about or changed (seccomp, and Landlock
 *   where the kernel has it); nothing written to files, no core;
 *   no sockets, no programs, no memory that can be executed, nothing done to other processes: all system
 *   calls that decoding does not need fail with EPERM (seccomp);
 *   processor time at most `seconds`; memory at most `memory` bytes more than now (0: no limit);
 *   no rights of root's
 *
 * With sanitizers, whose own needs are others, there is no limit on memory and no filter. False if the
 * filter cannot be set up, and on systems that have no cage here: then the file must not be read. */
bool wr_sandbox_enter(uint64_t memory, unsigned seconds);

/* The parts of it, in this order; each must hold without the one before. */
void wr_sandbox_limit(uint64_t memory, unsigned seconds);
void wr_sandbox_close_files(void);
bool wr_sandbox_filter_calls(void);

/* Bytes of address space that this process has; to be asked before the cage is entered. */
uint64_t wr_sandbox_space(void);
/* Lower the limit on memory to `memory` bytes beyond `space`; does nothing if it is lower already. */
void wr_sandbox_memory(uint64_t space, uint64_t memory);
