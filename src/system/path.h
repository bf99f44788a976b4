/* path.h - files and folders by path. Functions that fail set errno.
   Belongs to one system: platform code, see src/README.md. */
#pragma once
#include "system/fd.h"

#ifdef __cplusplus
extern "C" {
#endif

/* Information about a file, or a link's target. */
bool wr_path_info(const char *path, WrFileInfo *info);
bool wr_path_is_folder(const char *path);
bool wr_path_is_file(const char *path);

/* Access checks for this user; links are followed. */
bool wr_path_is_there(const char *path);
bool wr_path_can_read(const char *path);
bool wr_path_can_write(const char *path);
bool wr_path_can_run(const char *path); /* a folder: can be entered */

bool wr_path_remove(const char *path);                 /* a file or a link */
bool wr_path_rename(const char *from, const char *to); /* replaced atomically if it exists */
bool wr_path_link(const char *from, const char *to);   /* a hard link */
bool wr_path_read_link(const char *path, char *to, size_t size);
/* Absolute path without links and dots; release with free(). NULL on failure. */
char *wr_path_real(const char *path);
/* Current folder; release with free(). NULL on failure. */
char *wr_path_here(void);

/* The user's home folder in the system's user database. */
bool wr_path_home(char *path, size_t size);

/* ---- folders ---- */

typedef enum WrFolderFor {
    WR_FOLDER_FOR_ALL, /* mode from the user's mask */
    WR_FOLDER_FOR_ME   /* accessible by the owner only */
} WrFolderFor;
bool wr_folder_make(const char *path, WrFolderFor whose);
/* Creates a new folder for the owner only: the six X at the end of `path` become its name. */
bool wr_folder_make_temporary(char *path);
bool wr_folder_remove(const char *path); /* must be empty */

typedef struct WrFolder WrFolder;
WrFolder *wr_folder_open(const char *path); /* NULL on failure */
void wr_folder_close(WrFolder *folder);     /* NULL is allowed */
/* The next entry, in no order, without "." and ".."; valid until the next call. NULL at the end. */
const char *wr_folder_next(WrFolder *folder);
/* Information about an entry; links are not followed. */
bool wr_folder_entry_info(WrFolder *folder, const char *name, WrFileInfo *info);
bool wr_folder_remove_entry(WrFolder *folder, const char *name);

/* Opens the entry for reading and locks it, if it is a regular file of this user that nobody has
   locked. -1 otherwise. */
int wr_folder_open_unheld(WrFolder *folder, const char *name);
/* Removes the entry if it is a regular file of this user that nobody has locked, and was not replaced
 * meanwhile. */
void wr_folder_remove_unheld_entry(WrFolder *folder, const char *name);

#ifdef __cplusplus
}
#endif
