/* file_program.h - a program of the desktop's that asks for a file: zenity or kdialog, whichever is there. */
#pragma once
#include "system/process.h"

#include <stdbool.h>
#include <stddef.h>

/* Start it, without a shell.
 *
 * save      a file to be written
 * start_at  the path that it begins with
 * child     to be waited for: by one of those below
 * pipe      what it answers is read from; the caller closes it
 * False     neither is there, or it could not be started: nothing is to be waited for or closed */
bool wr_file_program_start(const char *title, bool save, const char *start_at, WrPid *child,
                           int *pipe);
/* Wait until it ends. answer: [size], size > 0, the path that it gave, "" if none; the pipe stays open. Any thread. */
void wr_file_program_hear(WrPid child, int pipe, char *answer, size_t size);
void wr_file_program_dismiss(WrPid child); /* tell it to end, and wait until it has */
