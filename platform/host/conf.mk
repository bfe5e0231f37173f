# The default of `make CONF=`: programs of this machine.
HOST_SRC = $(wildcard platform/host/*.c)
