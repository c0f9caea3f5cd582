// The invitation's token stands behind the # of the link, which no browser sends anywhere. It is taken out of the
// address at once; the ticket that replaces it lives as long as this tab.

const kToken = 'bonemill.token';

export function takeToken(): string {
  const token = location.hash.slice(1);
  if (location.hash) history.replaceState(null, '', location.pathname + location.search);
  try {
    if (token) sessionStorage.setItem(kToken, token);
    return token || (sessionStorage.getItem(kToken) ?? '');
  } catch {
    return token;  // a browser that stores nothing: it lives as long as the page
  }
}

// An empty one forgets it.
export function keepTicket(ticket: string): void {
  try {
    if (ticket) sessionStorage.setItem(kToken, ticket);
    else sessionStorage.removeItem(kToken);
  } catch {
    // A browser that stores nothing.
  }
}
