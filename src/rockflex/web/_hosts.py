"""Addresses that a server may listen on."""

from ipaddress import ip_address


def page_address(host: str, port: int) -> str:
    """Return the address of the page in a browser."""
    return f"http://{f'[{host}]' if ':' in host else host}:{port}"


def is_loopback_host(host: str) -> bool:
    """Tell whether an address is reached from this machine only."""
    return host.lower() == "localhost" or (is_numeric_host(host) and ip_address(host).is_loopback)


def is_host_of_all_addresses(host: str) -> bool:
    """Tell whether an address stands for all addresses of this machine."""
    return not host or (is_numeric_host(host) and ip_address(host).is_unspecified)


def is_numeric_host(host: str) -> bool:
    """Tell whether a host is given by numbers."""
    try:
        ip_address(host)
    except ValueError:
        return False
    return True
