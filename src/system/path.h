/* path.h - files by their names. Where a function fails, errno says why.
   Belongs to one system: platform code, see src/README.md. */
#pragma once
#include "system/fd.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Of what stands behind a link; of the link itself. */
bool wr_path_info(const char *path, WrFileInfo *info);
bool wr_path_info_itself(const char *path, WrFileInfo *info);
bool wr_path_is_folder(const char *path);
bool wr_path_is_file(const char *path);

/* As this user may; links are followed. */
bool wr_path_is_there(const char *path);
bool wr_path_can_read(const char *path);
bool wr_path_can_write(const char *path);
bool wr_path_can_run(const char *path); /* a folder: can be gone through */

bool wr_path_remove(const char *path);                 /* a file's name, or a link */
bool wr_path_rename(const char *from, const char *to); /* which is replaced at once */
bool wr_path_link(const char *from, const char *to);   /* a second name of the same file */
bool wr_path_read_link(const char *path, char *to, size_t size);
/* Whole, without links and dots; free() gives it back. NULL. */
char *wr_path_real(const char *path);
/* The folder that names are seen from; free() gives it back. NULL. */
char *wr_path_here(void);

/* The user's folder, as the system's list of users has it. */
bool wr_path_home(char *path, size_t size);

/* ---- folders ---- */

typedef enum WrFolderFor {
    WR_FOLDER_FOR_ALL, /* as the user's mask says */
    WR_FOLDER_FOR_ME   /* nobody else's to look into */
} WrFolderFor;
bool wr_folder_make(const char *path, WrFolderFor whose);
/* A new one, nobody else's: the six X at the end of `path` become its name. */
bool wr_folder_make_temporary(char *path);
bool wr_folder_remove(const char *path); /* an empty one */

typedef struct WrFolder WrFolder;
WrFolder *wr_folder_open(const char *path); /* NULL */
void wr_folder_close(WrFolder *folder);     /* NULL is fine */
/* The next name in it, in no order, without "." and ".."; valid until the next call. NULL at the end. */
const char *wr_folder_next(WrFolder *folder);
/* What has that name in it; links are not followed. */
bool wr_folder_info(WrFolder *folder, const char *name, WrFileInfo *info);
bool wr_folder_drop(WrFolder *folder, const char *name);

/* Open the file of that name for reading if it is a file of our user's and nobody holds a lock on it; the lock is ours
   then. -1. */
int wr_folder_open_unheld(WrFolder *folder, const char *name);
/* Remove the file of that name if it is a file of our user's, nobody holds a lock on it, and it is that one still. */
void wr_folder_drop_unheld(WrFolder *folder, const char *name);

#ifdef __cplusplus
}
#endif
