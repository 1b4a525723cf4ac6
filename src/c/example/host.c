/* What the product needs on a workstation. */

#include <stdio.h>
#include <stdlib.h>

void product(void);

void print(const char *text) {
    fputs(text, stdout);
}

void leave(int status) {
    exit(status);
}

int main(void) {
    product();
    return 0;
}
