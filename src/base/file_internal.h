/* file_internal.h - what the files that write files share.
   Layer 0. Private to this room. */
#pragma once
#include "base/file.h"
#include "system/path.h"

/* FOLDER/.NAME.PID-HOST-RANDOM.part.ENDING: whose it is, and what nobody can know beforehand. ending may be "".
   Caller frees; NULL. */
char *wr_file_hidden_name(const char *folder, const char *name, const char *ending);
/* The process of this machine whose file of half the way that is, by the name alone; 0: no such file. */
long wr_file_owner(const char *name);
void wr_file_sync_folder(const char *path); /* of the file of that name */

/* ---- file_sums.c: checksums of all bytes that were handed to a file ---- */

typedef struct WrFileSums WrFileSums;
WrFileSums *wr_file_sums_new(void);
void wr_file_sums_free(WrFileSums *sums); /* NULL is fine */
/* Bytes that are about to be written to fd. Where they cover earlier ones in part, those are read back and compared: false
   and errno, EIO if the file holds others. */
bool wr_file_sums_note(WrFileSums *sums, int fd, const void *bytes, size_t length, int64_t at);
int64_t wr_file_sums_end(const WrFileSums *sums); /* where the file should end */
/* Read the whole file and compare: false and errno, EIO if the file holds other bytes. Also false, whatever errno says,
   when the work is cancelled. */
bool wr_file_sums_check(WrFileSums *sums, int fd);

/* ---- file_group.c ---- */

/* A whole file waits under its temporary name: true if there is a group, which takes both names. */
bool wr_file_group_takes(WrFileTarget *target);
/* Where that is the list of a group whose process is gone: give its files their names. */
void wr_file_group_finish(const char *folder, WrFolder *dir, const char *name);
