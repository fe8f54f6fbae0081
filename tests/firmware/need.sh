# need PROGRAM...: ends the test as skipped (77), with a message, if a program is missing.
need() {
    for program; do
        command -v "$program" > /dev/null && continue
        echo "skipped: needs $program (make test-deps)"
        exit 77
    done
}

# semihosted BOARD ELF: runs a program in QEMU, a nanosecond per instruction; returns its output and exit code.
semihosted() {
    timeout 120 qemu-system-arm -M "$1" -display none -monitor none -serial none -chardev stdio,id=out \
        -icount shift=0 -semihosting-config enable=on,target=native,chardev=out -kernel "$2"
}
