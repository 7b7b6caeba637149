/* The way in and out of a run, and a counter of instructions. */
#include <stddef.h>
#include <stdint.h>

int receive(void *bytes, size_t size);
int send(const void *bytes, size_t size);
uint32_t count(void);
uint32_t instructions(uint32_t counts);
int run(void);
