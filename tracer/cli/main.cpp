// The program: one file a sub-command, and one place that maps errors to the exit status.
int main() { return 0; }
