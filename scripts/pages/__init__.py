"""What the documentation is built and tested with."""
