/* file_internal.h - functions shared by the file*.c files.
   Private to this module. */
#pragma once
#include "base/file.h"
#include "system/path.h"

/* FOLDER/.NAME.PID-HOST-RANDOM.part.ENDING: contains its owner and an unpredictable part. ending may be
   "". Caller frees; NULL on failure. */
char *wr_file_hidden_name(const char *folder, const char *name, const char *ending);
/* Process id of this machine that the temporary file's name contains; 0: not such a name. */
long wr_file_owner(const char *name);
void wr_file_sync_folder(const char *path); /* syncs the folder of this file */

/* ---- file_sums.c: checksums of all bytes written to a file ---- */

typedef struct WrFileSums WrFileSums;
WrFileSums *wr_file_sums_new(void);
void wr_file_sums_free(WrFileSums *sums); /* NULL is fine */
/* Records bytes before they are written to fd. If they partly cover earlier bytes, those are read back
   and compared: false and errno, EIO if the file contains other bytes. */
bool wr_file_sums_note(WrFileSums *sums, int fd, const void *bytes, size_t length, int64_t at);
int64_t wr_file_sums_end(const WrFileSums *sums); /* expected length of the file */
/* Reads the whole file and compares it: false and errno, EIO if the file contains other bytes. Also
   false, with any errno, when the work is cancelled. */
bool wr_file_sums_check(WrFileSums *sums, int fd);

/* ---- file_group.c ---- */

/* Leaves a finished file under its temporary name if this thread has a group: returns true, and the
 * group owns both names. */
bool wr_file_group_takes(WrFileTarget *target);
/* If `name` is the list of a group whose process has ended, renames its files. */
void wr_file_group_finish(const char *folder, WrFolder *dir, const char *name);
