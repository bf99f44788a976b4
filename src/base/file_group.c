/* Group commit of several files (file.h).

   Before the first rename, a list of all files is written to their folder and synced: lines
   "TEMPORARY/TARGET" between a first and a last line that mark it as complete. */
#include "base/array.h"
#include "base/error.h"
#include "base/file_internal.h"
#include "base/memory.h"
#include "base/text.h"
#include "system/fd.h"
#include "system/process.h"

#include <errno.h>
#include <string.h>

#define LIST_ENDING "together"
#define LIST_FIRST "files that belong together\n"
#define LIST_LAST "/\n"
#define LIST_MOST 65536 /* bytes */

typedef struct Member {
    char *temporary, *path; /* owned */
    char *before;           /* temporary name of the previous target file; owned; NULL: there was
                               none */
    bool linked;            /* `before` is a hard link beside the original name */
    bool placed;
} Member;

struct WrFileGroup {
    WR_ARRAY(Member) members;
    char *list; /* owned; NULL: not written */
};

static _Thread_local WrFileGroup *here;

WrFileGroup *wr_file_group_begin(void)
{
    WR_ASSERT(!here);
    here = wr_alloc(1, sizeof *here);
    return here;
}

bool wr_file_group_is_open(void)
{
    return here != NULL;
}

const char *wr_file_group_last(void)
{
    if (!here || here->members.count == 0) return NULL;
    return here->members.data[here->members.count - 1].temporary;
}

bool wr_file_group_takes(WrFileTarget *target)
{
    if (!here) return false;
    const Member member = { .temporary = target->temporary, .path = target->path };
    wr_array_push(&here->members, member);
    wr_file_sums_free(target->sums);
    *target = (WrFileTarget){ .fd = -1 };
    return true;
}

/* Removes a file, with one retry: no other process removes it before this one has ended. */
static void take_away(const char *path)
{
    if (!wr_path_remove(path) && errno != ENOENT) wr_path_remove(path);
}

static void end(WrFileGroup *group)
{
    for (int i = 0; i < group->members.count; i++) {
        const Member *m = &group->members.data[i];
        if (!m->placed) take_away(m->temporary);
        wr_free(m->temporary);
        wr_free(m->path);
        wr_free(m->before);
    }
    wr_array_free(&group->members);
    wr_free(group->list);
    wr_free(group);
    here = NULL;
}

void wr_file_group_abort(WrFileGroup *group)
{
    if (group) end(group);
}

/* ---- the list ---- */

static const char *name_of(const char *path)
{
    const char *slash = strrchr(path, '/');
    return slash ? slash + 1 : path;
}

static bool in_folder(const char *path, const char *folder)
{
    char *its = wr_path_folder(path);
    bool same = strcmp(its, folder) == 0;
    wr_free(its);
    return same;
}

static bool put_list(WrFileGroup *group, const WrText *text)
{
    const unsigned how =
        WR_OPEN_WRITE | WR_OPEN_NEW | WR_OPEN_NO_LINK | WR_OPEN_PRIVATE | WR_OPEN_READ;
    int fd = wr_fd_open(group->list, how);
    if (fd < 0) return false;
    bool good = wr_fd_write(fd, text->data, text->length) && wr_fd_sync(fd);
    int why = errno;
    good = wr_fd_close(fd) && good;
    if (good) return true;
    if (why) errno = why;
    return false;
}

/* A single file needs no list: one rename is atomic. */
static bool write_list(WrFileGroup *group, const char *folder)
{
    if (group->members.count < 2) return true;
    WrText text = { 0 };
    wr_text_add(&text, LIST_FIRST);
    for (int i = 0; i < group->members.count; i++) {
        const Member *m = &group->members.data[i];
        if (in_folder(m->path, folder) && !strchr(name_of(m->path), '\n'))
            wr_text_addf(&text, "%s/%s\n", name_of(m->temporary), name_of(m->path));
    }
    wr_text_add(&text, LIST_LAST);
    group->list = wr_file_hidden_name(folder, "files", LIST_ENDING);
    bool good = group->list && put_list(group, &text);
    wr_text_fini(&text);
    return good;
}

static void drop_list(WrFileGroup *group)
{
    if (group->list) take_away(group->list);
}

/* ---- names ---- */

/* Gives the existing target a second name before any rename. Creating a name needs space in the folder;
   a rename over an existing name hardly does. On file systems without hard links, place() renames the
   target. */
static bool link_before(Member *m)
{
    if (!wr_path_is_there(m->path)) return true;
    char *folder = wr_path_folder(m->path);
    m->before = wr_file_hidden_name(folder, "before", "");
    wr_free(folder);
    if (!m->before) return false;
    m->linked = wr_path_link(m->path, m->before);
    return m->linked || errno == EPERM || errno == EOPNOTSUPP || errno == ENOSYS || errno == EMLINK;
}

static bool place(Member *m)
{
    if (m->before && !m->linked && !wr_path_rename(m->path, m->before)) return false;
    m->placed = wr_path_rename(m->temporary, m->path);
    return m->placed;
}

/* Restores the previous target. A disk that refuses to rename may still link and unlink; then the name
   is missing for a moment. */
static bool name_before(const Member *m)
{
    return wr_path_rename(m->before, m->path) ||
           (m->linked && wr_path_remove(m->path) &&
            (wr_path_link(m->before, m->path) || wr_path_rename(m->before, m->path)));
}

/* Restores one member. False: the new file or no file has the target's name, and the previous file
 * keeps its temporary name. */
static bool put_back(Member *m)
{
    const bool moved = m->placed || (m->before && !m->linked && wr_path_is_there(m->before));
    bool good = true;
    if (moved && m->before) good = name_before(m);
    else if (m->placed) good = wr_path_remove(m->path) || wr_path_remove(m->path);
    if (good && m->before) take_away(m->before);
    return good;
}

/* The error becomes "A: cannot be written (why); new, though: B, C". */
static void put_all_back(WrFileGroup *group, WrError *err)
{
    WrText new = { 0 };
    for (int k = group->members.count - 1; k >= 0; k--) {
        Member *m = &group->members.data[k];
        if (!put_back(m)) wr_text_addf(&new, "%s%.80s", new.length ? ", " : "", name_of(m->path));
    }
    if (new.length && err) {
        const WrError first = *err;
        wr_fail(err, "%s; these could not be put back and are new: %s", first.text, new.data);
    }
    wr_text_fini(&new);
}

static bool place_all(WrFileGroup *group, WrError *err)
{
    Member *const first = group->members.data, *const behind = first + group->members.count;
    Member *m = first;
    char why[WR_FILE_WHY];
    while (m < behind && link_before(m)) m++;
    if (m == behind)
        for (m = first; m < behind && place(m);) m++;
    if (m == behind) return true;
    wr_fail(err, "%s: cannot be written (%s)", m->path, wr_file_why(errno, why));
    drop_list(group); /* first, so that no sweep continues the group */
    put_all_back(group, err);
    return false;
}

static void forget_before(const WrFileGroup *group)
{
    for (int i = 0; i < group->members.count; i++)
        if (group->members.data[i].before) take_away(group->members.data[i].before);
}

bool wr_file_group_commit(WrFileGroup *group, WrError *err)
{
    if (group->members.count == 0) return end(group), true;
    const char *first = group->members.data[0].path;
    char *folder = wr_path_folder(first), why[WR_FILE_WHY];
    bool good = write_list(group, folder);
    if (!good) {
        wr_fail(err, "%s: cannot be written (%s)", folder, wr_file_why(errno, why));
        drop_list(group);
    }
    if (good) wr_file_sync_folder(first);
    good = good && place_all(group, err);
    if (good) {
        wr_file_sync_folder(first);
        forget_before(group);
        drop_list(group);
    }
    end(group);
    wr_free(folder);
    return good;
}

/* ---- after a kill ---- */

/* True for a plain name of this folder, without a path. */
static bool is_plain(const char *name)
{
    return *name && strcmp(name, ".") != 0 && strcmp(name, "..") != 0 && !strchr(name, '/');
}

static void finish_one(const char *folder, WrFolder *dir, long process, char *line)
{
    char *target = strchr(line, '/');
    if (!target) return;
    *target++ = '\0';
    if (!is_plain(target) || wr_file_owner(line) != process) return;
    int fd = wr_folder_open_unheld(dir, line);
    if (fd < 0) return;
    char *from = wr_path_join(folder, line), *to = wr_path_join(folder, target);
    wr_path_rename(from, to);
    wr_fd_close(fd);
    wr_free(from);
    wr_free(to);
}

static void finish_all(const char *folder, WrFolder *dir, long process, char *text)
{
    const size_t first = sizeof LIST_FIRST - 1, last = sizeof LIST_LAST - 1, length = strlen(text);
    if (length < first + last || strncmp(text, LIST_FIRST, first) != 0 ||
        strcmp(text + length - last, LIST_LAST) != 0)
        return;
    text[length - last] = '\0';
    for (char *line = text + first; *line;) {
        char *next = line + strcspn(line, "\n");
        if (*next) *next++ = '\0';
        finish_one(folder, dir, process, line);
        line = next;
    }
}

void wr_file_group_finish(const char *folder, WrFolder *dir, const char *name)
{
    const size_t length = strlen(name), ending = sizeof ".part." LIST_ENDING - 1;
    if (length < ending || strcmp(name + length - ending, ".part." LIST_ENDING) != 0) return;
    int fd = wr_folder_open_unheld(dir, name);
    if (fd < 0) return;
    char *text = wr_alloc(LIST_MOST + 1, 1);
    int64_t have = wr_fd_read(fd, text, LIST_MOST);
    if (have > 0) finish_all(folder, dir, wr_file_owner(name), text);
    wr_free(text);
    wr_fd_close(fd);
}
