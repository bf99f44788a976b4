/* file_program.h - native file dialog by an external program: zenity or kdialog, whichever is installed. */
#pragma once
#include "system/process.h"

#include <stdbool.h>
#include <stddef.h>

/* Start it, without a shell.
 *
 * save      a file to be written
 * start_at  initial path
 * child     must be waited for with one of the functions below
 * pipe      the answer is read from it; the caller closes it
 * False     neither is installed, or it could not be started; nothing is to be waited for or closed */
bool wr_file_program_start(const char *title, bool save, const char *start_at, WrPid *child,
                           int *pipe);
/* Wait for its end. answer: [size], size > 0, the chosen path, "" if none; the pipe stays open. Any thread. */
void wr_file_program_hear(WrPid child, int pipe, char *answer, size_t size);
void wr_file_program_dismiss(WrPid child); /* terminate it and wait for its end */
