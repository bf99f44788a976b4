/* channel.h - two processes of this machine that talk, and hand open files to each other.
   Belongs to one system: platform code, see src/README.md. */
#pragma once
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define WR_CHANNEL_FILES 4 /* that can come with one message */

/* Both ends. packets: what is sent in one piece arrives in one piece; else it is a stream of bytes. */
bool wr_channel_pair(int ends[2], bool packets);
bool wr_channel_is_one(int fd);

/* Send a head and a body (length may be 0) and `count` open files, which stay open here. False when the other end is
   gone, which raises no signal. Heads are far smaller than what a channel holds. */
bool wr_channel_send(int channel, const void *head, size_t head_length, const void *body,
                     size_t length, const int *files, int count);
/* The same of one piece, if that can be done without waiting. */
void wr_channel_try_send(int channel, const void *bytes, size_t length);

/* As many of the bytes, of a stream, as go without waiting: 0 while there is no room; -1: the other end is gone. */
int64_t wr_channel_put(int channel, const void *bytes, size_t length);
/* Wait until there is room, or the other end is gone; false when the time is over. */
bool wr_channel_wait_room(int channel, int ms);
void wr_channel_end(int channel); /* the other end reads to here and no further */

/* Receive up to `length` bytes, and files that came along: files[count], -1 where there are fewer; those beyond are
   closed. Returns how many bytes; 0: the other end is gone; -1: it failed; -2: nothing, ask again. */
int64_t wr_channel_receive(int channel, void *bytes, size_t length, int *files, int count);

/* Wait until something can be received. ms < 0: for ever. */
typedef enum WrChannelNews { WR_CHANNEL_QUIET, WR_CHANNEL_NEWS, WR_CHANNEL_FAILED } WrChannelNews;
WrChannelNews wr_channel_wait(int channel, int ms);
bool wr_channel_has_byte(int channel); /* not only the other end's farewell */

/* Wait for any of several, ms < 0: for ever: those with `reads` until they can be read, and all until the other end is
   gone. *news: whether anything came, or only the time is over. False if it was for nothing. */
typedef struct WrWaited {
    int fd; /* -1: is left out */
    bool reads;
    bool news, gone; /* out */
} WrWaited;
bool wr_channel_wait_for_any(WrWaited *waited, int count, int ms, bool *news);
