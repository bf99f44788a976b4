#include "base/file.h"

#include "base/array.h"
#include "base/error.h"
#include "base/hash.h"
#include "base/memory.h"
#include "base/progress.h"
#include "base/text.h"
#include "system/fd.h"
#include "system/file_permissions.h"
#include "system/path.h"
#include "system/process.h"

#include <ctype.h>
#include <errno.h>
#include <limits.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

/* ---- identity ---- */

WrFileIdentity wr_file_identity(const char *path)
{
    WrFileInfo info;
    if (!wr_path_info(path, &info)) return (WrFileIdentity){ 0 };
    return (WrFileIdentity){ .there = true,
                             .device = info.device,
                             .inode = info.inode,
                             .bytes = info.bytes,
                             .seconds = info.seconds,
                             .nanoseconds = info.nanoseconds };
}

bool wr_file_identity_same(const WrFileIdentity *a, const WrFileIdentity *b)
{
    return a->there == b->there && a->device == b->device && a->inode == b->inode &&
           a->bytes == b->bytes && a->seconds == b->seconds && a->nanoseconds == b->nanoseconds;
}

/* ---- Opening of files named by others (file.h) ---- */

static const char *const kinds[] = {
    [WR_KIND_FILE] = "a file",          [WR_KIND_FOLDER] = "a folder",
    [WR_KIND_LINK] = "a link",          [WR_KIND_PIPE] = "a pipe",
    [WR_KIND_SOCKET] = "a socket",      [WR_KIND_DEVICE] = "a device",
    [WR_KIND_OTHER] = "no regular file"
};

static bool check_kind(const char *path, const WrFileInfo *info, WrError *err)
{
    if (info->kind == WR_KIND_FILE) return true;
    return wr_fail(err, "%s: is %s; a file is needed", path, kinds[info->kind]);
}

/* The kind is checked before opening, since opening a device may have effects, and again after it: the
 * file may have been replaced. */
static int open_regular(const char *path, unsigned how, WrFileInfo *info, WrError *err)
{
    bool there = wr_path_info(path, info);
    if (there && !check_kind(path, info, err)) return -1;
    int fd = wr_fd_open(path, how | WR_OPEN_NO_WAIT);
    if (fd < 0 || !wr_fd_info(fd, info)) wr_fail(err, "%s: %s", path, strerror(errno));
    else if (check_kind(path, info, err)) return fd;
    if (fd >= 0) wr_fd_close(fd);
    return -1;
}

static int open_to_read(const char *path, unsigned how, uint64_t limit, uint64_t *length,
                        WrError *err)
{
    WrFileInfo info;
    int fd = open_regular(path, WR_OPEN_READ | how, &info, err);
    if (fd < 0) return -1;
    if ((uint64_t)info.bytes > limit) {
        wr_fail(err, "%s: %.1f MB is over the limit of %.1f MB", path, (double)info.bytes / 1e6,
                (double)limit / 1e6);
        wr_fd_close(fd);
        return -1;
    }
    if (length) *length = (uint64_t)info.bytes;
    return fd;
}

int wr_file_open(const char *path, uint64_t limit, uint64_t *length, WrError *err)
{
    return open_to_read(path, 0, limit, length, err);
}

int wr_file_open_no_link(const char *path, uint64_t limit, uint64_t *length, WrError *err)
{
    return open_to_read(path, WR_OPEN_NO_LINK, limit, length, err);
}

int wr_file_open_truncate(const char *path, WrError *err)
{
    int fd = wr_fd_open(path, WR_OPEN_WRITE | WR_OPEN_CREATE | WR_OPEN_EMPTY | WR_OPEN_NO_WAIT);
    if (fd < 0) wr_fail(err, "%s: cannot be written: %s", path, strerror(errno));
    return fd;
}

size_t wr_file_peek(const char *path, void *bytes, size_t count)
{
    WrError err;
    uint64_t length;
    int fd = wr_file_open(path, WR_FILE_MAX, &length, &err);
    if (fd < 0) return 0;
    int64_t n = wr_fd_read_at(fd, bytes, count < length ? count : (size_t)length, 0);
    wr_fd_close(fd);
    return n > 0 ? (size_t)n : 0;
}

bool wr_file_read(const char *path, size_t limit, char **bytes, size_t *length, WrError *err)
{
    uint64_t size;
    int fd = wr_file_open(path, limit, &size, err);
    if (fd < 0) return false;
    size_t want = (size_t)size, have = 0;
    char *block = wr_try_alloc(want + 1, 1, path, err);
    if (!block) goto fail;
    /* A file may shrink or grow while it is read: at most the size at opening is read, and *length is the number of bytes
       that came. */
    while (have < want) {
        int64_t n = wr_fd_read(fd, block + have, want - have);
        if (n < 0) {
            wr_fail(err, "%s: %s", path, strerror(errno));
            goto fail;
        }
        if (n == 0) break;
        have += (size_t)n;
    }
    block[have] = '\0';
    wr_fd_close(fd);
    *bytes = block;
    *length = have;
    return true;
fail:
    wr_free(block);
    wr_fd_close(fd);
    return false;
}

char *wr_path_folder(const char *path)
{
    const char *slash = strrchr(path, '/');
    if (!slash) return wr_strdup(".");
    if (slash == path) return wr_strdup("/");
    return wr_strndup(path, (size_t)(slash - path));
}

char *wr_path_join(const char *folder, const char *path)
{
    if (path[0] == '/' || !folder || !*folder || strcmp(folder, ".") == 0) return wr_strdup(path);
    WrText text = { 0 };
    wr_text_addf(&text, "%s%s%s", folder, folder[strlen(folder) - 1] == '/' ? "" : "/", path);
    return text.data;
}

/* The extension in lower case, at most 15 letters; a name that begins with its only dot (".config") has none. */
const char *wr_path_ending(const char *path, char buffer[16])
{
    const char *slash = strrchr(path, '/'), *name = slash ? slash + 1 : path;
    const char *dot = strrchr(name, '.');
    size_t n = 0;
    if (dot && dot != name)
        for (dot++; dot[n] && n < 15; n++) buffer[n] = (char)tolower((unsigned char)dot[n]);
    buffer[n] = '\0';
    return buffer;
}

int wr_fd_in_memory(const char *name, const void *bytes, size_t length, WrError *err)
{
    int fd = wr_fd_memory("wrinkle");
    if (fd >= 0 && wr_fd_write(fd, bytes, length) && wr_fd_seek(fd, 0) == 0) return fd;
    wr_fail(err, "%s: not enough memory to read it (%s)", name, strerror(errno));
    if (fd >= 0) wr_fd_close(fd);
    return -1;
}

char *wr_scratch_new(WrError *err)
{
    const char *root = getenv("TMPDIR");
    char *folder = wr_path_join(root && *root ? root : "/tmp", "wrinkle-XXXXXX");
    if (wr_folder_make_temporary(folder)) return folder;
    wr_fail(err,
            "%s: the folder for temporary files cannot be created; set TMPDIR to another folder",
            folder);
    wr_free(folder);
    return NULL;
}

void wr_scratch_free(char *path)
{
    WrFolder *folder = path ? wr_folder_open(path) : NULL;
    if (folder)
        for (const char *name; (name = wr_folder_next(folder));)
            wr_folder_remove_entry(folder, name);
    wr_folder_close(folder);
    if (path) wr_folder_remove(path);
    wr_free(path);
}

char *wr_config_path(const char *name)
{
    const char *xdg = getenv("XDG_CONFIG_HOME"), *home = getenv("HOME");
    WrText path = { 0 };
    if (xdg && xdg[0] == '/') wr_text_addf(&path, "%s/wrinkle/%s", xdg, name);
    else if (home && home[0] == '/') wr_text_addf(&path, "%s/.config/wrinkle/%s", home, name);
    return path.data;
}

static char chosen_folder[4096]; /* as set; "": none */

void wr_program_folder_set(const char *folder)
{
    snprintf(chosen_folder, sizeof chosen_folder, "%s", folder ? folder : "");
}

char *wr_program_folder(void)
{
    char exe[4096];
    if (*chosen_folder) return wr_strdup(chosen_folder);
    if (wr_process_program(exe, sizeof exe)) return wr_path_folder(exe);
    return wr_strdup("."); /* the system does not report the path */
}

/* The checkout of a program that runs in its build folder, whose file wrinkle.checkout has the path; else NULL. The caller frees
   it. */
static char *checkout_folder(const char *program_folder)
{
    char *name = wr_path_join(program_folder, "wrinkle.checkout"), *text = NULL;
    size_t length;
    if (wr_file_read(name, 4096, &text, &length, NULL)) text[strcspn(text, "\n")] = '\0';
    wr_free(name);
    return text;
}

bool wr_data_find(const char *name, WrText *path)
{
    char *folder = wr_program_folder(), *checkout = checkout_folder(folder);
    const struct {
        const char *folder, *tail;
    } places[] = { { getenv("WRINKLE_DATA"), "" },
                   { folder, "/../share/wrinkle" },
                   { folder, "/.." },
                   { checkout, "" } };
    bool found = false;
    for (size_t i = 0; i < sizeof places / sizeof *places && !found; i++) {
        if (!places[i].folder) continue;
        wr_text_clear(path);
        wr_text_addf(path, "%s%s/%s", places[i].folder, places[i].tail, name);
        found = wr_path_can_read(wr_text_get(path));
    }
    wr_free(folder);
    wr_free(checkout);
    return found;
}

/* The default is that of the XDG Base Directory Specification. */
bool wr_shared_find(const char *name, WrText *path)
{
    const char *folders = getenv("XDG_DATA_DIRS");
    if (!folders || !*folders) folders = "/usr/local/share:/usr/share";
    for (const char *at = folders; *at;) {
        const size_t length = strcspn(at, ":");
        if (*at == '/') { /* relative folders are invalid */
            wr_text_clear(path);
            wr_text_addf(path, "%.*s/%s", (int)length, at, name);
            if (wr_path_can_read(wr_text_get(path))) return true;
        }
        at += length + (at[length] == ':');
    }
    return false;
}

/* ---- atomic replacement ---- */

/* Atomic replacement of files (file.h). Every file that the program writes uses it. */

typedef struct WrFileSums WrFileSums;

/* Leaves a finished file under its temporary name if this thread has a group: returns true, and the
 * group owns both names. */
static bool file_group_takes(WrFileTarget *target);
/* If `name` is the list of a group whose process has ended, renames its files. */
static void file_group_finish(const char *folder, WrFolder *dir, const char *name);

/* ---- file sums ---- */

/* Checksums of the bytes written to a file.

   The file is a list of contiguous extents in the order of their offsets, each with a checksum. A write
   at the end extends the last extent, up to EXTENT bytes. A write over earlier bytes (an encoder's
   header, the lengths in an archive) replaces extents. If it covers an extent in part, the whole extent
   is read back and compared first, then its remaining part gets its own checksum. So every byte is
   compared at least once and none is kept in memory. */

#define EXTENT ((int64_t)1 << 18) /* bytes, at most */

typedef struct Extent {
    int64_t at, length;
    WrHash hash;
} Extent;

struct WrFileSums {
    WR_ARRAY(Extent) extents;
    WrHashStream *stream; /* of the last extent while it grows */
    bool grows;
    char *block; /* [EXTENT], for reading back */
};

static WrFileSums *file_sums_new(void)
{
    WrFileSums *sums = wr_alloc(1, sizeof *sums);
    sums->stream = wr_hash_stream_new();
    return sums;
}

/* NULL is fine */
static void file_sums_free(WrFileSums *sums)
{
    if (!sums) return;
    wr_hash_stream_free(sums->stream);
    wr_array_free(&sums->extents);
    wr_free(sums->block);
    wr_free(sums);
}

/* expected length of the file */
static int64_t file_sums_end(const WrFileSums *sums)
{
    if (sums->extents.count == 0) return 0;
    const Extent *last = &sums->extents.data[sums->extents.count - 1];
    return last->at + last->length;
}

static WrHash hash_of(const void *bytes, int64_t length)
{
    return wr_hash_bytes(bytes, (size_t)length, (WrHash){ .low = 0, .high = 0 });
}

static void stop_growing(WrFileSums *sums)
{
    if (sums->grows)
        sums->extents.data[sums->extents.count - 1].hash = wr_hash_stream_get(sums->stream);
    sums->grows = false;
}

/* ---- at the end ---- */

static void grow(WrFileSums *sums, const char *bytes, int64_t length)
{
    while (length > 0) {
        Extent *last = sums->grows ? &sums->extents.data[sums->extents.count - 1] : NULL;
        if (!last || last->length == EXTENT) {
            stop_growing(sums);
            const Extent next = { .at = file_sums_end(sums) };
            wr_array_push(&sums->extents, next);
            wr_hash_stream_begin(sums->stream);
            sums->grows = true;
            continue;
        }
        const int64_t room = EXTENT - last->length, take = length < room ? length : room;
        wr_hash_stream_add(sums->stream, bytes, (size_t)take);
        last->length += take;
        bytes += take;
        length -= take;
    }
}

/* Gaps read as zeros. */
static void grow_by_zeros(WrFileSums *sums, int64_t length)
{
    static const char zeros[1 << 14];
    for (; length > 0; length -= (int64_t)sizeof zeros)
        grow(sums, zeros, length < (int64_t)sizeof zeros ? length : (int64_t)sizeof zeros);
}

/* ---- over earlier bytes ---- */

/* Reads an extent into `block` and compares its checksum. errno EIO: the file contains other bytes. */
static bool read_back(WrFileSums *sums, int fd, const Extent *e)
{
    if (!sums->block) sums->block = wr_alloc_unset((size_t)EXTENT, 1);
    for (int64_t have = 0; have < e->length;) {
        const int64_t n =
            wr_fd_read_at(fd, sums->block + have, (size_t)(e->length - have), e->at + have);
        if (n == 0) errno = EIO;
        if (n <= 0) return false;
        have += n;
    }
    errno = EIO;
    return wr_hash_equal(hash_of(sums->block, e->length), e->hash);
}

/* Index of the first extent that ends after `at`. */
static int find(const WrFileSums *sums, int64_t at)
{
    int low = 0, high = sums->extents.count;
    while (low < high) {
        const int middle = (low + high) / 2;
        const Extent *e = &sums->extents.data[middle];
        if (e->at + e->length > at) high = middle;
        else low = middle + 1;
    }
    return low;
}

/* Replaces the extents [first, first + count) by others. */
static void replace(WrFileSums *sums, int first, int count, const Extent *others, int other_count)
{
    const int behind = sums->extents.count - first - count;
    for (int i = count; i < other_count; i++) wr_array_push(&sums->extents, others[i]);
    Extent *at = sums->extents.data + first;
    memmove(at + other_count, at + count, (size_t)behind * sizeof *at);
    memcpy(at, others, (size_t)other_count * sizeof *at);
    sums->extents.count = first + other_count + behind;
}

/* Overwrites at most EXTENT bytes, [at, at + length), all before the end. */
static bool write_over(WrFileSums *sums, int fd, const char *bytes, int64_t length, int64_t at)
{
    const int64_t end = at + length;
    const int first = find(sums, at);
    int last = first, count = 0;
    Extent others[3];
    while (sums->extents.data[last].at + sums->extents.data[last].length < end) last++;
    const Extent *a = &sums->extents.data[first], *b = &sums->extents.data[last];
    const int64_t before = at - a->at, after = b->at + b->length - end;
    if (before > 0 && !read_back(sums, fd, a)) return false;
    if (before > 0) others[count++] = (Extent){ a->at, before, hash_of(sums->block, before) };
    others[count++] = (Extent){ at, length, hash_of(bytes, length) };
    if (after > 0 && !(a == b && before > 0) && !read_back(sums, fd, b)) return false;
    if (after > 0)
        others[count++] = (Extent){ end, after, hash_of(sums->block + b->length - after, after) };
    replace(sums, first, last - first + 1, others, count);
    return true;
}

/* Records bytes before they are written to fd. If they partly cover earlier bytes, those are read back
   and compared: false and errno, EIO if the file contains other bytes. */
static bool file_sums_note(WrFileSums *sums, int fd, const void *bytes, size_t length, int64_t at)
{
    const char *from = bytes;
    const int64_t old_end = file_sums_end(sums), end = at + (int64_t)length;
    if (length == 0) return true;
    if (at < old_end) stop_growing(sums);
    for (const int64_t stop = end < old_end ? end : old_end; at < stop;) {
        const int64_t piece = stop - at < EXTENT ? stop - at : EXTENT;
        if (!write_over(sums, fd, from, piece, at)) return false;
        from += piece;
        at += piece;
    }
    if (at > old_end) grow_by_zeros(sums, at - old_end);
    grow(sums, from, end - at);
    return true;
}

/* Reads the whole file and compares it: false and errno, EIO if the file contains other bytes. Also
   false, with any errno, when the work is cancelled. */
static bool file_sums_check(WrFileSums *sums, int fd)
{
    WrFileInfo info;
    if (!wr_fd_info(fd, &info)) return false;
    errno = EIO;
    if (info.bytes != file_sums_end(sums)) return false;
    stop_growing(sums);
    for (int i = 0; i < sums->extents.count; i++) {
        if (wr_progress_stopped() || !read_back(sums, fd, &sums->extents.data[i])) return false;
    }
    return true;
}

#define TRIES 16 /* attempts to find a free name */

/* ---- temporary names ---- */

/* Links are followed by hand, so that a link to a file that does not exist yet works too. */
static char *resolve_links(const char *path, WrError *err)
{
    char *now = wr_strdup(path);
    for (int hops = 0; hops < 40; hops++) {
        char link[4096];
        if (!wr_path_read_link(now, link, sizeof link)) return now;
        char *folder = wr_path_folder(now), *next = wr_path_join(folder, link);
        wr_free(folder);
        wr_free(now);
        now = next;
    }
    wr_free(now);
    wr_fail(err, "%s: too many symbolic links", path);
    return NULL;
}

uint32_t wr_file_host(void)
{
    char name[256];
    if (!wr_process_machine(name, sizeof name)) return 0;
    return (uint32_t)wr_hash_bytes(name, strlen(name), (WrHash){ .low = 0, .high = 0 }).low;
}

/* FOLDER/.NAME.PID-HOST-RANDOM.part.ENDING: contains its owner and an unpredictable part. ending may be
   "". Caller frees; NULL on failure. */
static char *file_hidden_name(const char *folder, const char *name, const char *ending)
{
    uint64_t random = 0;
    WrText text = { 0 };
    if (!wr_random_bytes(&random, sizeof random)) return NULL;
    wr_text_addf(&text, "%s/.%.100s.%ld-%08x-%016llx.part%s%s", folder, name, (long)wr_process_id(),
                 (unsigned)wr_file_host(), (unsigned long long)random, *ending ? "." : "", ending);
    return text.data;
}

/* Skips digits of the base; returns the rest, NULL if there are no digits. */
static const char *skip_digits(const char *text, int base)
{
    const char *p = text;
    while (base == 10 ? isdigit((unsigned char)*p) : isxdigit((unsigned char)*p)) p++;
    return p > text ? p : NULL;
}

/* In a folder shared by several machines, only processes of this machine can be checked. */
static long file_owner(const char *name)
{
    const char *tail = NULL;
    if (name[0] != '.') return 0;
    for (const char *p = name; (p = strstr(p, ".part")); p++) tail = p;
    if (!tail || (tail[5] != '\0' && tail[5] != '.')) return 0;
    const char *dot = tail;
    while (dot > name && dot[-1] != '.') dot--;
    const char *dash = dot > name + 1 ? skip_digits(dot, 10) : NULL;
    const char *end = dash && *dash == '-' ? skip_digits(dash + 1, 16) : NULL;
    if (end && *end == '-') { /* older versions wrote no host */
        if (strtoull(dash + 1, NULL, 16) != wr_file_host()) return 0;
        end = skip_digits(end + 1, 16);
    }
    long pid = end == tail ? strtol(dot, NULL, 10) : 0;
    return pid > 0 && pid < INT_MAX ? pid : 0;
}

void wr_file_sweep(const char *folder)
{
    for (int pass = 0; pass < 2; pass++) { /* files of a group's list must not be removed before the
                                              list is processed */
        WrFolder *dir = wr_folder_open(folder);
        for (const char *name; dir && (name = wr_folder_next(dir));) {
            long pid = file_owner(name);
            if (!pid || wr_process_lives(pid)) continue;
            if (pass == 0) file_group_finish(folder, dir, name);
            else wr_folder_remove_unheld_entry(dir, name);
        }
        wr_folder_close(dir);
    }
}

/* ---- writing ---- */

void wr_file_outlive_size_limit(void)
{
    wr_process_outlive_file_limit();
}

/* ---- messages of the system ---- */

static const struct {
    int error;
    const char *help;
} helps[] = {
    { ENOSPC, "make room, or write to another disk" },
    { EDQUOT, "make room, or write where there is no quota" },
    { EROFS, "write to another disk" },
    { EIO, "the disk may be failing: write to another" },
    { EFBIG, NULL }, /* from the file size limit */
};

const char *wr_file_why(int error, char text[WR_FILE_WHY])
{
    const char *reason = strerror(error), *help = NULL;
    const uint64_t limit = wr_process_file_limit();
    for (size_t i = 0; i < sizeof helps / sizeof *helps; i++)
        if (helps[i].error == error) help = helps[i].help;
    if (error == EFBIG && limit != WR_LIMIT_NONE) {
        snprintf(text, WR_FILE_WHY, "%s: at most %llu bytes are allowed here (ulimit -f)", reason,
                 (unsigned long long)limit);
        return text;
    }
    snprintf(text, WR_FILE_WHY, "%s%s%s", reason, help ? ": " : "", help ? help : "");
    return text;
}

const char *wr_file_why_of_library(const char *reason, char text[WR_FILE_WHY])
{
    for (size_t i = 0; i < sizeof helps / sizeof *helps; i++)
        if (strstr(reason, strerror(helps[i].error))) return wr_file_why(helps[i].error, text);
    return reason;
}

bool wr_file_fail(const WrFileTarget *target, const char *reason, WrError *err)
{
    return wr_fail(err, "%s: cannot be written%s%s%s", target->path, *reason ? " (" : "", reason,
                   *reason ? ")" : "");
}

static bool fail_by_system(const WrFileTarget *target, WrError *err)
{
    char text[WR_FILE_WHY];
    return wr_file_fail(target, wr_file_why(errno, text), err);
}

/* ---- the target ---- */

static bool check_place(const char *path, const char *real, const char *folder, WrError *err)
{
    WrFileInfo info;
    bool exists = wr_path_info(real, &info);
    if (exists && info.kind == WR_KIND_FOLDER)
        return wr_fail(err, "%s: is a folder; a file name is needed", path);
    if (exists && info.kind != WR_KIND_FILE) return wr_fail(err, "%s: is not a regular file", path);
    if (!wr_path_is_there(folder)) return wr_fail(err, "%s: its folder does not exist", path);
    if (!wr_path_can_write(folder) || !wr_path_can_run(folder))
        return wr_fail(err, "%s: its folder cannot be written (%s)", path, strerror(errno));
    if (exists && !wr_path_can_write(real))
        return wr_fail(err, "%s: cannot be written (%s)", path, strerror(errno));
    return true;
}

/* Creates a new file that only the user can read, locked until it is released. */
static bool create(WrFileTarget *target, const char *folder, WrError *err)
{
    const char *slash = strrchr(target->path, '/'), *name = slash ? slash + 1 : target->path;
    const unsigned how =
        WR_OPEN_READ | WR_OPEN_WRITE | WR_OPEN_NEW | WR_OPEN_NO_LINK | WR_OPEN_PRIVATE;
    char ending[16];
    wr_path_ending(name, ending);
    errno = EEXIST;
    for (int i = 0; i < TRIES && target->fd < 0 && errno == EEXIST; i++) {
        wr_free(target->temporary);
        target->temporary = file_hidden_name(folder, name, ending);
        if (!target->temporary) break;
        target->fd = wr_fd_open(target->temporary, how);
    }
    if (target->fd < 0) return fail_by_system(target, err);
    wr_fd_lock(target->fd,
               WR_LOCK_ALONE); /* some file systems have no locks; the process id in the name is
                                  enough */
    return true;
}

static void release(WrFileTarget *target)
{
    if (target->path && target->fd >= 0) wr_fd_close(target->fd);
    wr_free(target->path);
    wr_free(target->temporary);
    file_sums_free(target->sums);
    *target = (WrFileTarget){ 0 };
}

static bool is_control(char c)
{
    return ((unsigned char)c < 0x20 && c != '\t') || c == 0x7f;
}

/* Commands are lines of text, so a file whose name contains a line break or another control character
   could not be opened again. The message shows ? for it, to stay one line. */
static bool check_letters(const char *path, WrError *err)
{
    char shown[120];
    snprintf(shown, sizeof shown, "%s", path);
    unsigned found = 0;
    for (const char *c = path; *c; c++)
        if (is_control(*c)) found = (unsigned char)*c;
    if (!found) return true;
    for (char *c = shown; *c; c++)
        if (is_control(*c)) *c = '?';
    return wr_fail(err,
                   "%s: the file name contains the control character 0x%02x, such as a line break; "
                   "choose another name",
                   shown, found);
}

bool wr_file_begin(WrFileTarget *target, const char *path, WrError *err)
{
    *target = (WrFileTarget){ 0 };
    if (!*path) return wr_fail(err, "the name of the file to write is empty");
    if (!check_letters(path, err)) return false;
    wr_file_outlive_size_limit();
    char *real = resolve_links(path, err);
    if (!real) return false;
    *target = (WrFileTarget){ .path = real, .fd = -1, .sums = file_sums_new() };
    char *folder = wr_path_folder(real);
    bool good = check_place(path, real, folder, err);
    if (good) wr_file_sweep(folder);
    good = good && create(target, folder, err);
    wr_free(folder);
    if (!good) release(target);
    return good;
}

bool wr_file_write_at(WrFileTarget *target, const void *bytes, size_t length, int64_t at)
{
    return file_sums_note(target->sums, target->fd, bytes, length, at) &&
           wr_fd_write_at(target->fd, bytes, length, at);
}

bool wr_file_put(WrFileTarget *target, const void *bytes, size_t length, WrError *err)
{
    return wr_file_write_at(target, bytes, length, file_sums_end(target->sums)) ||
           fail_by_system(target, err);
}

static bool sink_write(void *to, const void *bytes, size_t length, int64_t at)
{
    return wr_file_write_at(to, bytes, length, at);
}

WrByteSink wr_file_sink(WrFileTarget *target)
{
    return (WrByteSink){ sink_write, target };
}

/* syncs the folder of this file */
static void file_sync_folder(const char *path)
{
    char *folder = wr_path_folder(path);
    int fd = wr_fd_open(folder, WR_OPEN_READ);
    if (fd >= 0) {
        wr_fd_sync(fd); /* not supported by some file systems; the rename is valid anyway */
        wr_fd_close(fd);
    }
    wr_free(folder);
}

static bool give_rights(const WrFileTarget *target)
{
    if (wr_path_is_there(target->path)) return wr_rights_give_old(target->fd, target->path);
    char *folder = wr_path_folder(target->path);
    bool good = wr_rights_give_new(target->fd, folder);
    wr_free(folder);
    return good;
}

static bool check_bytes(const WrFileTarget *target, WrError *err)
{
    if (file_sums_check(target->sums, target->fd)) return true;
    if (wr_progress_stopped()) return wr_fail(err, "cancelled");
    if (errno != EIO) return fail_by_system(target, err);
    return wr_file_fail(target,
                        "it does not read back as it was written: the disk may be failing: write "
                        "to another",
                        err);
}

bool wr_file_commit(WrFileTarget *target, WrError *err)
{
    if (!check_bytes(target, err)) {
        wr_file_abort(target);
        return false;
    }
    bool good = give_rights(target) && wr_fd_sync(target->fd);
    int fd = target->fd;
    target->fd = -1;
    if (!good) {
        int saved = errno;
        wr_fd_close(fd);
        errno = saved;
    }
    /* Some file systems report write errors only on close. */
    good = good && wr_fd_close(fd);
    if (good && file_group_takes(target)) return true;
    good = good && wr_path_rename(target->temporary, target->path);
    if (!good) {
        fail_by_system(target, err);
        wr_file_abort(target);
        return false;
    }
    file_sync_folder(target->path);
    release(target);
    return true;
}

void wr_file_abort(WrFileTarget *target)
{
    /* One retry: no other process removes the file before this one has ended. */
    if (target->temporary && !wr_path_remove(target->temporary) && errno != ENOENT)
        wr_path_remove(target->temporary);
    release(target);
}

bool wr_file_write(const char *path, const void *bytes, size_t length, WrError *err)
{
    WrFileTarget target;
    if (!wr_file_begin(&target, path, err)) return false;
    if (!wr_file_put(&target, bytes, length, err)) {
        wr_file_abort(&target);
        return false;
    }
    return wr_file_commit(&target, err);
}

/* ---- file group ---- */

/* Group commit of several files (file.h).

   Before the first rename, a list of all files is written to their folder and synced: lines
   "TEMPORARY/TARGET" between a first and a last line that mark it as complete. */

#define LIST_ENDING "together"
#define LIST_FIRST "files that belong together\n"
#define LIST_LAST "/\n"
#define LIST_MAX 65536 /* bytes */

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

static bool file_group_takes(WrFileTarget *target)
{
    if (!here) return false;
    const Member member = { .temporary = target->temporary, .path = target->path };
    wr_array_push(&here->members, member);
    file_sums_free(target->sums);
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
    group->list = file_hidden_name(folder, "files", LIST_ENDING);
    bool good = group->list && put_list(group, &text);
    wr_text_fini(&text);
    return good;
}

static void drop_list(WrFileGroup *group)
{
    if (group->list) take_away(group->list);
}

/* ---- names of a group ---- */

/* Creates a second name for the existing target before any rename. Creating a name needs space in the folder;
   a rename over an existing name hardly does. On file systems without hard links, place() renames the
   target. */
static bool link_before(Member *m)
{
    if (!wr_path_is_there(m->path)) return true;
    char *folder = wr_path_folder(m->path);
    m->before = file_hidden_name(folder, "before", "");
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
        wr_fail(err, "%s; these files could not be restored and are already replaced: %s",
                wr_error_message(&first), new.data);
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
    if (good) file_sync_folder(first);
    good = good && place_all(group, err);
    if (good) {
        file_sync_folder(first);
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
    if (!is_plain(target) || file_owner(line) != process) return;
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

static void file_group_finish(const char *folder, WrFolder *dir, const char *name)
{
    const size_t length = strlen(name), ending = sizeof ".part." LIST_ENDING - 1;
    if (length < ending || strcmp(name + length - ending, ".part." LIST_ENDING) != 0) return;
    int fd = wr_folder_open_unheld(dir, name);
    if (fd < 0) return;
    char *text = wr_alloc(LIST_MAX + 1, 1);
    int64_t have = wr_fd_read(fd, text, LIST_MAX);
    if (have > 0) finish_all(folder, dir, file_owner(name), text);
    wr_free(text);
    wr_fd_close(fd);
}
