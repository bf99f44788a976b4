/* channel.h - message channels between two processes of this machine, with passing of open files.
   Belongs to one system: platform code, see src/README.md. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define WR_CHANNEL_FILES 4 /* maximum number of files in one message */

/* Creates both ends. packets: messages keep their boundaries; otherwise a stream of bytes. */
bool wr_channel_pair(int ends[2], bool packets);
bool wr_channel_is_one(int fd);

/* Sends a head and a body (length may be 0) and `count` open files, which stay open here. False when
   the other end is closed; no signal is raised. Heads are far smaller than the channel's buffer. */
bool wr_channel_send(int channel, const void *head, size_t head_length, const void *body,
                     size_t length, const int *files, int count);
/* Sends one message if that is possible without blocking. */
void wr_channel_try_send(int channel, const void *bytes, size_t length);

/* Writes as many bytes of a stream as possible without blocking: 0 if the buffer is full; -1 if the
 * other end is closed. */
int64_t wr_channel_put(int channel, const void *bytes, size_t length);
/* Waits until there is space, or the other end is closed; false on timeout. */
bool wr_channel_wait_room(int channel, int ms);
void wr_channel_end(int channel); /* shuts down sending: the other end reads an end of file */

/* Receives up to `length` bytes and attached files: files[count], -1 where there are fewer; excess
   files are closed. Returns the number of bytes; 0: the other end is closed; -1: failure; -2: nothing
   yet, try again. */
int64_t wr_channel_receive(int channel, void *bytes, size_t length, int *files, int count);

/* Waits until something can be received. ms < 0: no timeout. */
typedef enum WrChannelNews { WR_CHANNEL_QUIET, WR_CHANNEL_NEWS, WR_CHANNEL_FAILED } WrChannelNews;
WrChannelNews wr_channel_wait(int channel, int ms);
bool wr_channel_has_byte(int channel); /* data is available, not only an end of file */

/* Waits for any of several channels, ms < 0: no timeout: those with `reads` until they are readable,
   all until the other end is closed. *news: false on timeout. Returns false on failure. */
typedef struct WrWaited {
    int fd; /* -1: ignored */
    bool reads;
    bool news, gone; /* out */
} WrWaited;
bool wr_channel_wait_for_any(WrWaited *waited, int count, int ms, bool *news);
