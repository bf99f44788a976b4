/* process.h - this process: identity, memory, limits, exit and interrupts. Belongs to one system:
   platform code, see src/README.md. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef int64_t WrPid; /* a process number; above 0 */

WrPid wr_process_id(void);
bool wr_process_lives(WrPid process); /* true also if unknown */
/* Name of this machine; false if unknown. */
bool wr_process_machine(char *name, size_t size);

/* Bytes of address space, bytes of resident memory; 0 if unknown. */
uint64_t wr_process_space(void);
uint64_t wr_process_resident(void);

/* Path of the running program; false if unknown. */
bool wr_process_program(char *path, size_t size);
/* Stores main's argument 0 for systems that do not report the path. */
void wr_process_called(const char *argument);

/* True if standard error is a terminal. */
bool wr_process_has_terminal(void);
/* True if a GPU seems to be available to this user. */
bool wr_process_has_gpu(void);

/* ---- limits ---- */

#define WR_LIMIT_NONE UINT64_MAX
uint64_t wr_process_file_limit(void); /* maximum bytes of a written file */
/* Makes exceeding that limit a write error, not the end of the program. */
void wr_process_outlive_file_limit(void);

/* Makes writing to a pipe that nobody reads an error, not the end of the program. */
void wr_process_outlive_pipes(void);

/* Lowers a limit permanently. */
typedef enum WrLimit { WR_LIMIT_CORE, WR_LIMIT_FILE, WR_LIMIT_FILES, WR_LIMIT_SPACE } WrLimit;
void wr_process_limit(WrLimit what, uint64_t most);
/* Limits processor time in seconds. At the limit the process receives a signal and ends as
   WR_CHILD_LATE; a second later it is killed. */
void wr_process_limit_time(unsigned seconds);

/* True if a sandbox for child processes is available (system/sandbox.h). */
bool wr_process_has_cage(void);

/* ---- the end ---- */

/* Continues as another program, with the same number, open standard streams and folder. arguments: the first is its
   name, the last NULL. Returns only on failure, with errno's value. */
int wr_process_become(const char *program, char *const *arguments);
/* Ends at once: nothing is flushed and no exit handler runs. */
_Noreturn void wr_process_leave(int status);
/* Registers a function that runs at exit with the program's status, before handlers registered earlier;
   one per program. False if the system does not report the status: then nothing is called. */
bool wr_process_at_end(void (*work)(int status));

/* Ends this child process when its parent ends, where supported. False if the parent has already ended. */
bool wr_process_die_with(WrPid parent);
/* Prevents programs started from now on from gaining privileges, where supported. */
void wr_process_keep_rights(void);
/* Starts a session of its own: terminal interrupts no longer reach this process. */
void wr_process_stand_alone(void);
/* Changes to the root folder, so that no folder is kept from being removed. */
bool wr_process_leave_folder(void);
/* Waits, some seconds at most, until every other thread sleeps, so that a fork inherits no held lock.
   Where the system reports no thread states: a tenth of a second. */
void wr_process_wait_for_threads(void);
void wr_process_hear_signals(void); /* unblocks all signals */

/* ---- terminal interrupts and termination requests ---- */

/* The first of either calls `work`, which must be async-signal-safe; the second ends the program.
   `seconds` after the first, the program ends by itself. Blocking input calls are interrupted. */
void wr_process_catch_interrupts(void (*work)(void), unsigned seconds);
void wr_process_drop_interrupts(void); /* restores the default: they end the program */
