/* sandbox.h - a sandbox for the process that reads untrusted files.

   Used only by the reader process: a library of its own, wr_sandbox.
   Belongs to one system: platform code, see src/README.md. */
#pragma once
#include <stdbool.h>
#include <stdint.h>

/* Restricts this process permanently:
 *
 *    no files except those already open: no path can be opened, queried or changed (seccomp, and Landlock
 *    where the kernel has it); no file writes, no core dumps;
 *    no sockets, no programs, no executable memory, no access to other processes: all system
 *    calls that decoding does not need fail with EPERM (seccomp);
 *    processor time at most `seconds`; memory at most `memory` bytes more than now (0: no limit);
 *    no root privileges
 *
 * With sanitizers, which need more system calls and memory, there is no memory limit and no filter.
 * Returns false if the filter cannot be installed, or on systems without a sandbox here: then the file
 * must not be read. */
bool wr_sandbox_enter(uint64_t memory, unsigned seconds);

/* The steps of it, in this order; each must work without the previous ones. */
void wr_sandbox_limit(uint64_t memory, unsigned seconds);
void wr_sandbox_close_files(void);
bool wr_sandbox_filter_calls(void);

/* Bytes of address space of this process; call it before entering the sandbox. */
uint64_t wr_sandbox_space(void);
/* Lowers the memory limit to `memory` bytes above `space`; does nothing if it is already lower. */
void wr_sandbox_memory(uint64_t space, uint64_t memory);
