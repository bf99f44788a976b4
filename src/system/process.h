/* process.h - this process: what it has, what ends it.
   Belongs to one system: platform code, see src/README.md. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

typedef int64_t WrPid; /* the number of a process; over 0 */

WrPid wr_process_id(void);
bool wr_process_lives(WrPid process); /* also where it is not known */
/* The name of the machine that it is a number on; false where the system does not say. */
bool wr_process_machine(char *name, size_t size);

/* Bytes of addresses that it has, bytes of it that are in memory; 0 where the system does not say. */
uint64_t wr_process_space(void);
uint64_t wr_process_resident(void);

/* The file of the running program; false where the system does not say. */
bool wr_process_program(char *path, size_t size);
/* How it was called, for systems that do not say: main tells its argument 0. */
void wr_process_called(const char *argument);

/* Whether somebody watches what goes to standard error. */
bool wr_process_has_terminal(void);
/* Whether there is a processor for pictures that this user may use, as far as the system tells. */
bool wr_process_has_gpu(void);

/* ---- limits ---- */

#define WR_LIMIT_NONE UINT64_MAX
uint64_t wr_process_file_limit(void); /* bytes of a file, for all that is written here */
/* Have such a limit be an error of writing, not the end of the program. */
void wr_process_outlive_file_limit(void);

/* For good: no more than that. */
typedef enum WrLimit { WR_LIMIT_CORE, WR_LIMIT_FILE, WR_LIMIT_FILES, WR_LIMIT_SPACE } WrLimit;
void wr_process_limit(WrLimit what, uint64_t most);
/* Seconds of processor time. At the limit it is told, and can be seen to have been (WR_CHILD_LATE); a second later
   it ends whatever it does. */
void wr_process_limit_time(unsigned seconds);

/* Whether a child can be kept from all that it is not given (system/sandbox.h). */
bool wr_process_has_cage(void);

/* ---- the end ---- */

/* At once: nothing is written out, and nothing called that waits for the end. */
_Noreturn void wr_process_leave(int status);
/* Have it called at the end, with the program's status, before what was registered earlier; one for the whole program.
   False where the system cannot tell the status: then nothing is called. */
bool wr_process_at_end(void (*work)(int status));

/* This process, a child, ends when its parent does, where the system has such. False if the parent is gone already. */
bool wr_process_die_with(WrPid parent);
/* No program that is started from now on has rights that this one has not, where the system has such. */
void wr_process_keep_rights(void);
/* Of a session of its own: an interrupt from the terminal is others' affair. */
void wr_process_stand_alone(void);
/* In the folder above all, so that it keeps none from being removed. */
bool wr_process_leave_folder(void);
/* Until every other thread sleeps, so that a copy of this process inherits nothing that one holds; some seconds at
   most. Where the system does not tell, a tenth of a second. */
void wr_process_wait_for_threads(void);
void wr_process_hear_signals(void); /* all of them, whatever was kept from it */

/* ---- interrupts from the terminal, and requests to end ---- */

/* The first one of either calls `work`, which may do no more than a signal's handler may; the second ends the program.
   `seconds` after the first the program ends by itself. What waits for input is interrupted. */
void wr_process_catch_interrupts(void (*work)(void), unsigned seconds);
void wr_process_drop_interrupts(void); /* they end the program again */
